#pragma once
#include <optional>

#include "cloth/core/particles.h"
#include "cloth/kernels/implicit_kernels.h"
#include "cloth/sheet/freedom.h"
#include "cloth/solver/node_arrays.h"

namespace weft {

/// The formula by which a node's move in an implicit substep makes its new velocity (kernels::BackwardStep).
/// By second order it is BDF2's where the last substep's move and velocity, which this remembers, may be
/// used: not in the first substep, nor in one of another length, nor where contact began or ended (Implicit).
/// All else is stepped by backward Euler.
template <class Real>
class StepFormula {
 public:
  StepFormula(const Grid& grid, bool second_order);
  StepFormula(const StepFormula&) = delete;  // coefficients() point into it
  StepFormula& operator=(const StepFormula&) = delete;

  const Grid& grid() const { return goes_on_.grid(); }
  /// A step begins whose substeps have h seconds.
  void begin_step(const Particles<Real>& particles, double h);
  /// A substep begins in this state. Nodes whose motion breaks here are told before prepare().
  void begin_substep(const Particles<Real>& particles);
  /// The node's motion is broken in this substep: it goes by backward Euler, without a past.
  void break_motion(std::size_t node);
  /// All nodes' are, in the substep after it as well.
  void break_all();
  /// Finds the coefficients by what has been told.
  void prepare();
  const kernels::BackwardStep<Real>& coefficients() const { return step_; }
  /// Back to where the substep began.
  void return_to_start(Particles<Real>& particles) const;
  /// As the substep ends; finds the nodes' accelerations, m/s2.
  void end_substep(Particles<Real>& particles);
  /// The node's next substep is one of backward Euler.
  void begin_anew(std::size_t node) { goes_on_.row(0)[node] = Real(0); }
  /// Its velocities were multiplied by this after the step: scales what is remembered of them (scale_motion).
  void scale(const Particles<Real>& particles, double factor, const Freedom& freedom);

  /// Positions, m, and velocities, m/s, as the substep began.
  const VectorField<Real>& start() const { return start_; }
  const VectorField<Real>& start_velocity() const { return start_velocity_; }
  /// By how many seconds places run ahead of speeds (EnergyLedger): of backward Euler, unless a node is held;
  /// 0 where the motion was broken. nullptr: none does.
  const Field<Real>* lead() const { return lead_ ? &*lead_ : nullptr; }
  /// Where it is above 0 a node is stepped by BDF2; nullptr: none is.
  const Field<Real>* by_bdf2() const { return second_order_ ? &goes_on_ : nullptr; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(goes_on_, last_move_, last_velocity_, h_);
  }

 private:
  bool second_order_;
  Field<Real> goes_on_;  ///< 1 where the last substep's move and velocity may be used, else 0
  VectorField<Real> last_move_, last_velocity_;  ///< m; m/s, as it began
  double h_ = 0;                                 ///< s, of the last substep
  VectorField<Real> start_, start_velocity_;
  std::optional<Field<Real>> lead_;
  NodeArrays<Real> rate_, vectors_;  ///< of step_
  kernels::BackwardStep<Real> step_{};
  bool smooth_ = true;  ///< break_all() was not called in the substep
};

extern template class StepFormula<float>;
extern template class StepFormula<double>;

}  // namespace weft
