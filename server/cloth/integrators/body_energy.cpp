#include "cloth/integrators/body_energy.h"

#include <Eigen/LU>
#include <algorithm>

#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"

namespace weft {
namespace {

/// Rounding and what a solve leaves, as a part of all the energy there may be.
constexpr double kLeft = 0.05;

double kinetic_energy_of(const std::vector<Solid>& solids) {
  double energy = 0;
  for (const Solid& solid : solids) {
    if (solid.yields()) energy += kinetic_energy(solid);
  }
  return energy;
}

/// Moves by itself, and so can do any work.
bool drives(const Solid& solid) {
  return !solid.yields() && (!solid.velocity.isZero(0) || !solid.turn.isZero(0));
}

}  // namespace

double kinetic_energy(const Solid& solid) {
  double energy = solid.velocity.squaredNorm() / (2 * solid.inverse_mass);
  if (solid.yields_turning()) energy += solid.spin.dot(solid.inverse_inertia.inverse() * solid.spin) / 2;
  return energy;
}

template <class Real>
void BodyEnergy<Real>::begin(const Particles<Real>& particles, const Forces<Real>& forces,
                             const std::vector<Solid>& solids, double dt) {
  applies_ = !forces.rescued && forces.pins == nullptr && forces.layers == nullptr && !forces.holds_gas() &&
             std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.yields(); }) &&
             std::none_of(solids.begin(), solids.end(), drives);
  if (!applies_) return;
  bodies_ = kinetic_energy_of(solids);
  cloth_ = kinetic_energy(particles) + forces.sheet->energy(particles.position);
  double mass = total_mass(particles);
  for (const Solid& solid : solids) mass += solid.yields() ? 1 / solid.inverse_mass : 0.0;
  pressed_ = mass * (standard_gravity() * dt).squaredNorm() / 2;
  start_ = particles.position;
  if (first_.grid() != particles.grid()) first_ = VectorField<Real>(particles.grid());
  forces.sum_effects(particles, first_);
}

template <class Real>
void BodyEnergy<Real>::judge(const Particles<Real>& particles, const Forces<Real>& forces,
                             const std::vector<Solid>& solids, AdvanceReport& report) {
  if (!applies_) return;
  const double gained = kinetic_energy(particles) + forces.sheet->energy(particles.position) - cloth_;
  if (gained <= kLeft * bodies_) return;
  const Grid& grid = particles.grid();
  if (last_.grid() != grid) last_ = VectorField<Real>(grid);
  forces.sum_effects(particles, last_);
  const auto first = kernels::components(std::as_const(first_)),
             last = kernels::components(std::as_const(last_));
  const auto from = kernels::components(std::as_const(start_)), to = kernels::components(particles.position);
  double work = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Vec3 way = at(to, i) - at(from, i);
    work += std::max(std::abs(at(first, i).dot(way)), std::abs(at(last, i).dot(way)));
  }
  const double lost = bodies_ - kinetic_energy_of(solids);
  const double could_give = std::max(0.0, lost + work + kLeft * (cloth_ + bodies_ + pressed_));
  if (gained <= could_give) return;
  report.gained = gained;
  report.could_give = could_give;
}

template class BodyEnergy<float>;
template class BodyEnergy<double>;

}  // namespace weft
