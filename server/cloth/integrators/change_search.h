#pragma once
#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/integrators/forces.h"
#include "cloth/solver/multigrid.h"

namespace weft {

/// What a change of the nodes' move does.
struct ChangeReport {
  double brought_in = 0;  ///< energy, J; below 0: given off
  /// How far the springs' and the gas's linearisation is off, or what is left to gain, J.
  double error = 0;
  double largest = 0;  ///< of that, in one spring, J
  double struck = 0;   ///< SpringModelError's
  bool taken = true;   ///< not dropped
  bool wild = false;   ///< brings in far more than was to be gained
};

/// One cloth's part of a change.
template <class Real>
struct ChangedPart {
  const Forces<Real>& forces;
  const ContactConstraints<Real>& contacts;
  Multigrid<Real>& system;
  /// The nodes as the linearisation has them: their positions, m, of the cloth's own place, with margins;
  /// their moves in the substep, and the change, which is scaled in place, m.
  kernels::Components<const Real> position, move;
  kernels::Components<Real> change;
  double stretched_to_twice;  ///< J, that all springs hold at their double length
};

/// How much of the change that a linear solve has found is taken, of all cloths that were solved together.
/// The solve gains `decrease`, J, by the linearisation, and a share s of its change s (2 - s) of that; what
/// it does beyond the springs, the gas and contact tell.
template <class Real>
class ChangeSearch {
 public:
  /// What the parts refer to is kept so. `layers` are the contacts among them, or nullptr.
  ChangeSearch(std::vector<ChangedPart<Real>> parts, const LayerContacts<Real>* layers);

  /// The whole, but less where contacts that the system did not hold come in its way (best_share), or where
  /// it is wild.
  ChangeReport take_whole(double decrease);
  /// Halved until it brings in no energy (Nocedal and Wright, Numerical Optimization, 2006, chapter 3);
  /// dropped if no share does.
  ChangeReport take_searched(double decrease);

 private:
  /// Of the change as it is.
  ChangeReport judge(double decrease) const;
  void scale(double share);

  std::vector<ChangedPart<Real>> parts_;
  const LayerContacts<Real>* layers_;
  double stretched_to_twice_ = 0;  ///< J
};

extern template class ChangeSearch<float>;
extern template class ChangeSearch<double>;

}  // namespace weft
