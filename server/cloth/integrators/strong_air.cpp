#include "cloth/integrators/strong_air.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// The air's damping rate times a part's length, at most.
constexpr double kTakenAlong = 4;
constexpr double kMostPartsInAir = 64;

}  // namespace

template <class Real>
int parts_in_strong_air(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  if (!forces.any_slow()) return 1;
  const double rate = forces.max_damping_rates(particles).slow;
  return static_cast<int>(std::ceil(std::clamp(h * rate / kTakenAlong, 1.0, kMostPartsInAir)));
}

template <class Real>
void find_velocity_in_air(const Particles<Real>& particles, const Forces<Real>& forces, double dt,
                          VectorField<Real>& velocity) {
  const Grid& grid = particles.grid();
  if (velocity.grid() != grid) velocity = VectorField<Real>(grid);
  forces.sum_slow(particles, velocity);
  const double rate = forces.max_damping_rates(particles).slow;
  const Real lasts = static_cast<Real>(dt / (1 + dt * rate / 2));
  const Real* inverse_mass = particles.inverse_mass.row(0);
  const auto add_velocity = [&](Field<Real>& component, const Field<Real>& now) {
    Real* sum = component.row(0);
    const Real* v = now.row(0);
    for (std::size_t i = 0; i < grid.size(); ++i) sum[i] = v[i] + lasts * inverse_mass[i] * sum[i];
  };
  add_velocity(velocity.x, particles.velocity.x);
  add_velocity(velocity.y, particles.velocity.y);
  add_velocity(velocity.z, particles.velocity.z);
}

template int parts_in_strong_air(const Particles<float>&, const Forces<float>&, double);
template int parts_in_strong_air(const Particles<double>&, const Forces<double>&, double);
template void find_velocity_in_air(const Particles<float>&, const Forces<float>&, double,
                                   VectorField<float>&);
template void find_velocity_in_air(const Particles<double>&, const Forces<double>&, double,
                                   VectorField<double>&);

}  // namespace weft
