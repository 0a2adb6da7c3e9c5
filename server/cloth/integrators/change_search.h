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

/// How much of the change that a linear solve has found is taken. The solve gains `decrease`, J, by the
/// linearisation, and a share s of its change s (2 - s) of that; what it does beyond the springs, the gas and
/// contact tell.
template <class Real>
class ChangeSearch {
 public:
  /// The nodes as the linearisation has them: their positions, m, of the cloth's own place, with margins;
  /// their moves in the substep, and the change, which is scaled in place, m.
  struct Nodes {
    kernels::Components<const Real> position, move;
    kernels::Components<Real> change;
  };
  /// All are kept by reference. `stretched_to_twice`, J, is what all springs hold at their double length.
  ChangeSearch(const Forces<Real>& forces, const ContactConstraints<Real>& contacts, Multigrid<Real>& system,
               const Nodes& nodes, double stretched_to_twice)
      : forces_(forces),
        contacts_(contacts),
        system_(system),
        nodes_(nodes),
        stretched_to_twice_(stretched_to_twice) {}

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

  const Forces<Real>& forces_;
  const ContactConstraints<Real>& contacts_;
  Multigrid<Real>& system_;
  Nodes nodes_;
  double stretched_to_twice_;
};

extern template class ChangeSearch<float>;
extern template class ChangeSearch<double>;

}  // namespace weft
