#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A cloth has been split (refine.h) this many times, and pinned nodes are among the new ones: Eq. 8 has put
/// them on chords of what the cloth is bent over, where contact, which moves free nodes alone, would leave
/// them for good. Those in a solid, as the step begins, leave it the way that the nodes between which they
/// lie look, by the mean of the surface's normals next to these, until they are on the surface; or, where
/// these themselves are held inside, as deep as they are in the mean. What the coarser level pinned stays.
///
/// The solids are as seen from the particles' place. Returns whether a node has moved.
template <class Real>
bool lift_new_pins(int splits, const std::vector<Solid>& solids, Particles<Real>& particles);

extern template bool lift_new_pins(int, const std::vector<Solid>&, Particles<float>&);
extern template bool lift_new_pins(int, const std::vector<Solid>&, Particles<double>&);

}  // namespace weft
