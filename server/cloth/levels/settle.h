#pragma once
#include "cloth/integrators/integrator.h"

namespace weft {

/// What would put energy into the springs that is no motion.
enum class Unsettled {
  no,
  /// Nodes taken over from a finer level leave the springs across folds compressed, new ones lie on chords,
  /// in solids too. Only what springs and plate hold beyond what they held at the level left is let go: what
  /// the cloth had stays, and where it gained nothing it keeps place and velocity to the bit.
  by_level,
  /// The start is tangled (unfold.h).
  by_tangle,
  /// A solid was put onto nodes: a ball of twice the size in a drape has a fifth of a metre to lift them, and
  /// a step that did so would send the hem off at 25 m/s.
  by_solid,
  /// Gas is there at once: 0.1 m3 in a bag that lies flat have 25 atmospheres and do 23 kJ of work before
  /// they have none. As motion that crumples it: a bag of 1 m a side that holds 0.1 J in its springs while it
  /// is smooth is left with 4 J, held by its own folds (level 5, explicit methods).
  by_gas,
};

/// As deep as a node of the cloth at this grid may be in a solid that it lies on, m.
double shallow(const ClothDescription& cloth, const Grid& grid);

/// Whether a solid has just been put onto free nodes, as all are when the step begins.
template <class Real>
bool is_put_onto(const Particles<Real>& particles, Contact<Real>& contact, const std::vector<Solid>& solids);

/// Lets springs and plate, seam and gas relax without motion: steps of backward Euler from rest, with no
/// effect at work, at the time of `forces`, among the solids as they are when the step begins; the velocities
/// stay as they were. Each lasts as long as a wave of stretch takes to run across the sheet, sqrt(density /
/// structural) times its size (`longest`, s, at most): what is stretched evens out, folds keep their shape.
///
/// By level there are no more of them once springs and plate hold no more than `enough`, J, and no node is
/// deep in a solid: none at all where that is so already.
///
/// Nothing happens if no relaxed state is found. Returns whether nodes have moved.
template <class Real>
bool settle(Particles<Real>& particles, Unsettled by, Forces<Real> forces, Contact<Real>* contact,
            const std::vector<Solid>& solids, double longest, double enough = 0);

}  // namespace weft
