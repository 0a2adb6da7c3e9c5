#pragma once
#include <optional>

#include "cloth/integrators/integrator.h"

namespace weft {

/// Holds a cloth that nothing drives (Forces::drive) to the energy that it has when that begins: motion,
/// springs, plate and height together. Nothing there gives it any, but the errors of steps do: the leading
/// apart of its own layers, and rounding, do work of either sign. What is beyond the bound is taken from the
/// motion (take_from_motion), so that momenta stay where nothing is held.
///
/// For symplectic Euler, which is leapfrog with velocities half a substep older than the positions (Hairer,
/// Lubich, Wanner, Geometric Numerical Integration, I.1.4): they are brought forward by half a substep's
/// force before the energy is seen or taken, and back afterwards. To take from the older ones would drive
/// stiff modes: of a mode of w rad/s leapfrog keeps (v^2 + w^2 x^2 - h w^2 x v) / 2, and where h w > sqrt(2)
/// that grows, in the mean, when v becomes 0.
///
/// To see the energy takes a pass over all springs. It is seen after every step while it is near the bound,
/// and ten times a second where it is far below.
template <class Real>
class EnergyBound {
 public:
  /// As a step of substeps of `h` seconds begins.
  void begin_step(Particles<Real>& particles, const Forces<Real>& forces, double h);
  /// After a step of `dt` seconds by such substeps. Returns what is left of each velocity, from 0 to 1.
  double end_step(Particles<Real>& particles, const Forces<Real>& forces, double h, double dt);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(most_, moving_, wait_);
  }

 private:
  /// The velocities become those when the nodes are where they are; velocity_ has what they were, and force_
  /// what made the difference.
  void bring_forward(Particles<Real>& particles, const Forces<Real>& forces, double h);

  std::optional<double> most_;  ///< J; nothing while the cloth is driven
  double moving_ = 0;           ///< the largest kinetic energy seen since, J
  double wait_ = 0;             ///< until the energy is seen again, s
  VectorField<Real> velocity_, force_;
};

extern template class EnergyBound<float>;
extern template class EnergyBound<double>;

}  // namespace weft
