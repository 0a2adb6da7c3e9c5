#pragma once
#include "cloth/core/particles.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// A sheet whose nodes have one coordinate in common, to the bit, has no force across that plane and stays in
/// it: there it may lock in folds that no sheet in space could keep, where rounding alone would let it out.
/// If it is such a sheet and has an edge that is compressed by more than 1 %, its free nodes are moved across
/// by at most the rounding of the places that they would have in any other plane; unstable as the fold is, it
/// opens from there. Nodes that are all in one point have no plane, and stay.
template <class Real>
void leave_plane(const Springs<Real>& springs, Particles<Real>& particles);

}  // namespace weft
