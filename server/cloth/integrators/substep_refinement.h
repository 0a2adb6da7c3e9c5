#pragma once
#include "cloth/integrators/integrator.h"

namespace weft {

/// How many times as many substeps as usual an XPBD step is made with: more at once where more are needed,
/// and one time fewer after every second in which fewer would do; at most 4 times.
///
/// XPBD passes a load on by a spring or two in a substep (xpbd.h). A sheet in violent motion, as in a gale,
/// is overstretched by that, and folds over itself where its nodes pass their neighbours within a substep: in
/// the calm it then hangs tangled, by a few of its springs. Therefore a step has as many substeps as it takes
///  - where structural springs are stretched by more than 5 %, for no node to go farther than half their
///    length in one;
///  - where cloth and a solid that it could be drawn round strike each other, for no node to be struck deeper
///    than a tenth of their length in one by what yields to the cloth, than 0.15 by what does not. A thread
///    of wave speed c struck across at v is stretched by e, v = c sqrt(2) e^(3/4) (Smith, McCrackin, Schiefer
///    1958, "Stress-strain relationships in yarns subjected to rapid impact loading"), and substeps of h let
///    no wave be faster than l / (h sqrt(2)): of springs of length l they stretch 5 and 8 %. A sheet too soft
///    for the blow is drawn past a thin rail cell by cell. Only where substeps soften springs by more than
///    5 %;
///  - under a pressure p, of gas or of wind, for a sheet of side L to be as stiff as p L; half as stiff it
///    bursts (inflation.h). Substeps of h leave a spring k between masses m no stiffer than 1 / (1 / k + 2
///    h^2 / m);
///  - where a hand pulls with F on a patch of width w, for it to be as stiff as F / w: what stretch asks for
///    would come too late.
///
/// So many substeps are kept while fewer would leave springs stretched by more than 5 % that by their own
/// stiffness are stretched by less: a tangled sheet's, which bear a good part of its weight each.
///
/// Shorter substeps stiffen the stretched springs, C^2 / (2 h^2 (w_i + w_j)), which brings energy in: not
/// asked for, therefore, where springs are half as long again already, and held so long. Without these two a
/// sheet of 1 mm, which its weight overstretches, swings for ever (measured).
template <class Real>
class SubstepRefinement {
 public:
  /// For a step of `dt` seconds that would have substeps of h seconds. `contact` is nullptr without solids.
  int begin_step(const Particles<Real>& particles, const Forces<Real>& forces, Contact<Real>* contact,
                 const std::vector<Solid>& solids, double h, double dt);
  void restart() { *this = {}; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(times_, held_);
  }

 private:
  int times_ = 1;
  double held_ = 0;  ///< s, that are left until that falls
};

extern template class SubstepRefinement<float>;
extern template class SubstepRefinement<double>;

}  // namespace weft
