#include "cloth/integrators/energy_bound.h"

#include <algorithm>

#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// Below the bound by this share of the largest kinetic energy, the energy is seen at intervals of so many
/// seconds.
constexpr double kFar = 0.1, kInterval = 0.1;

}  // namespace

template <class Real>
void EnergyBound<Real>::begin_step(const Particles<Real>& particles, const Forces<Real>& forces) {
  const bool driven = forces.drive != Drive::nothing;
  if (driven || forces.disturbed) *this = {};
  if (!driven && !most_) most_ = forces.energy(particles);
}

template <class Real>
double EnergyBound<Real>::end_step(Particles<Real>& particles, const Forces<Real>& forces, double dt) {
  if (!most_ || (wait_ -= dt) > 0) return 1;
  const double gain = forces.energy(particles) - *most_;
  moving_ = std::max(moving_, kinetic_energy(particles));
  wait_ = -gain > kFar * moving_ ? kInterval : 0;
  return take_from_motion(particles, gain);
}

template class EnergyBound<float>;
template class EnergyBound<double>;

}  // namespace weft
