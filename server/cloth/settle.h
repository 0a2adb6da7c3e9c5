#pragma once
#include "cloth/integrators/integrator.h"

namespace weft {

/// After a level change, for methods that would turn into motion what the change puts into the springs: nodes
/// taken over from a finer level leave the springs across folds compressed, new ones lie on chords, in solids
/// too. Lets springs and plate relax without motion: steps of backward Euler from rest, with no effect at
/// work, among the solids as they are when the step begins; the velocities stay as they were. Each lasts as
/// long as a wave of stretch takes to run across the sheet, sqrt(density / structural) times its size
/// (`longest`, s, at most): what is stretched evens out, folds keep their shape.
///
/// Nothing happens to a sheet without structural springs, and if no relaxed state is found.
template <class Real>
void settle(Particles<Real>& particles, const Springs<Real>& springs, const Plate<Real>* plate,
            const ClothDescription& cloth, Contact<Real>* contact, const std::vector<Solid>& solids,
            double longest);

}  // namespace weft
