#pragma once
#include <vector>

#include "cloth/world/cloth.h"
#include "cloth/world/cloth_contact.h"

namespace weft {

/// Number of parts, at least 1, into which the step of dt seconds from `time`, s, is divided.
///
/// Where cloths touch, in `layers` if there are any, each learns only once a step what the others and the
/// hands do, and what may meet in the step is predicted, worse the longer the step is. Parts are at most
/// 1/30 s long for the implicit steps of a single cloth, which finds all of it together; 1/60 s for those of
/// several cloths; 1/240 s for explicit steps, whose layers and cloths yield to each other in every substep,
/// by straight ways that were predicted as the part began.
///
/// Where one cloth moves past another, a step holds the few pairs of features that it predicts, and the net
/// has to stop the others: in a part the cloths move past each other by at most 4 cells, up to 4 parts.
///
/// With `solids` an implicit step stops nodes on straight ways: in a part pins move by at most half
/// of their cloth's larger side, up to 8 parts. Pins fixed to an obstacle do not count.
///
/// A body on a cloth that another body hits, or that the cloth throws off, is elsewhere than the cloth's step
/// expected, and may be through before the cloth feels it. In a part of an implicit step bodies that touch
/// the cloth, those that may hit them, and the cloth beside them where it touches them, go at most a quarter
/// of the body's inner radius, up to 4 parts; what touches a body that spins goes past it as fast as its
/// surface does.
template <class Real>
int step_parts(const std::vector<Cloth<Real>>& cloths, const ClothContact<Real>* layers,
               const std::vector<Solid>& solids, double time, double dt);

}  // namespace weft
