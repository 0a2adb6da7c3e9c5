#include "cloth/integrators/energy_bound.h"

#include <algorithm>
#include <utility>

#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// Below the bound by this share of the largest kinetic energy, the energy is seen at intervals of so many
/// seconds.
constexpr double kFar = 0.1, kInterval = 0.1;

}  // namespace

template <class Real>
void EnergyBound<Real>::begin_step(Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const bool driven = forces.drive != Drive::nothing;
  if (driven || forces.disturbed) {
    most_.reset();
    moving_ = wait_ = 0;
  }
  if (driven || most_) return;
  bring_forward(particles, forces, h);
  most_ = forces.energy(particles);
  std::swap(particles.velocity, velocity_);
}

template <class Real>
double EnergyBound<Real>::end_step(Particles<Real>& particles, const Forces<Real>& forces, double h,
                                   double dt) {
  if (!most_ || (wait_ -= dt) > 0) return 1;
  bring_forward(particles, forces, h);
  const double gain = forces.energy(particles) - *most_;
  moving_ = std::max(moving_, kinetic_energy(particles));
  wait_ = -gain > kFar * moving_ ? kInterval : 0;
  const double left = take_from_motion(particles, gain);
  if (left < 1) {
    accelerate(particles, force_, -h / 2);
  } else {
    std::swap(particles.velocity, velocity_);  // to the bit as it was
  }
  return left;
}

template <class Real>
void EnergyBound<Real>::bring_forward(Particles<Real>& particles, const Forces<Real>& forces, double h) {
  if (force_.grid() != particles.grid()) force_ = VectorField<Real>(particles.grid());
  velocity_ = particles.velocity;
  forces.sum(particles, force_);
  accelerate(particles, force_, h / 2);
}

template class EnergyBound<float>;
template class EnergyBound<double>;

}  // namespace weft
