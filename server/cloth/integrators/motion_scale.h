#pragma once
#include "cloth/core/particles.h"
#include "cloth/sheet/springs.h"
#include "cloth/solver/conjugate_gradients.h"

namespace weft {

/// How large the motion in an implicit substep is, and by that how large an error its solves may leave: a
/// share of the speeds that the nodes have, where nothing is pinned beside their mean velocity, or are given,
/// at most by gravity. On its way to rest a cloth is so solved ever more finely: errors that stayed the same
/// would shake it for ever.
template <class Real>
class MotionScale {
 public:
  MotionScale() = default;
  /// Of a cloth of these springs and nodes of these masses, in substeps of h seconds.
  MotionScale(const Springs<Real>& springs, const Field<Real>& mass, double h);

  /// As a substep begins.
  void measure(const Particles<Real>& particles);
  /// A solve of the substep lowers the energy by `decrease`, J. What is held up loses far less than what
  /// falls.
  void found(double decrease);
  /// The cloth will soon be at rest.
  bool near_rest() const { return kinetic_ <= mass_ * near_rest_ * near_rest_; }
  /// Near rest and held there. What gravity gives the nodes the springs then take away again: no measure of
  /// an error. Held to it, errors as large as the motion brake it: at 15 Hz a crumpled sheet takes 62 s to
  /// come to rest instead of 11, and the end of a narrow ribbon stays bent by 2 % of its length.
  bool fine() const { return near_rest() && !falls_; }
  /// Twice the energy of the motion that nodes have or, unless it is fine, gravity gives them in the substep,
  /// J. Of what nothing pins as seen from its mean velocity: in flight a sheet bends no more than at rest.
  double energy() const;
  /// Of solves that may be off by `tolerance` of the speed, of what nothing pins of that beside its mean
  /// velocity: how fast something carries it says nothing of an error. `contact`: something touches the
  /// cloth.
  SolveTarget target(double tolerance, bool contact) const;

 private:
  /// Twice the energy of the speed that gravity gives in the substep, J.
  double given() const;
  /// What energy() is where nothing moves.
  double still() const;

  double h_ = 0;
  double slow_ = 0;                ///< m/s, as slow as motion need be told from rest
  double near_rest_ = 0;           ///< m/s
  double mass_ = 0, kinetic_ = 0;  ///< kg, and twice the energy, J
  double inner_ = 0;               ///< kinetic_, where nothing is pinned without that of the mean velocity
  bool falls_ = false;             ///< in this substep
};

extern template class MotionScale<float>;
extern template class MotionScale<double>;

}  // namespace weft
