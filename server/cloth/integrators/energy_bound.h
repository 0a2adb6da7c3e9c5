#pragma once
#include <optional>

#include "cloth/integrators/integrator.h"

namespace weft {

/// Holds a cloth that nothing drives (Forces::drive) to the energy that it has when that begins: motion,
/// springs, plate and height together. Nothing there gives it any, but the errors of steps do: what solves
/// leave undone, and rounding, do work of either sign. What is beyond the bound is taken from the motion
/// (take_from_motion), so that momenta stay where nothing is held.
///
/// To see the energy takes a pass over all springs. It is seen after every step while it is near the bound,
/// and ten times a second where it is far below.
template <class Real>
class EnergyBound {
 public:
  /// As a step begins.
  void begin_step(const Particles<Real>& particles, const Forces<Real>& forces);
  /// After a step of `dt` seconds. Returns what is left of each velocity, relative, from 0 to 1: what else
  /// the integrator remembers of the motion it has to scale likewise (scale_motion).
  double end_step(Particles<Real>& particles, const Forces<Real>& forces, double dt);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(most_, moving_, wait_);
  }

 private:
  std::optional<double> most_;  ///< J; nothing while the cloth is driven
  double moving_ = 0;           ///< the largest kinetic energy seen since, J
  double wait_ = 0;             ///< until the energy is seen again, s
};

extern template class EnergyBound<float>;
extern template class EnergyBound<double>;

}  // namespace weft
