#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A cloth has been split (refine.h) this many times: Eq. 8 has put new nodes on chords of what it is bent
/// over. Those in a solid, as the step begins, leave it the way that the nodes between which they lie look,
/// by the surface's normal next to one of these or by the mean of those, whichever is shortest, or across the
/// sheet where they look opposite ways, until they are on the surface; or, where these themselves are held
/// inside, as deep as they are in the mean. What the coarser level had stays.
///
/// The solids are as seen from the particles' place. Both return whether a node has moved.

/// Those that are pinned, which contact, that moves free nodes alone, would leave inside for good.
template <class Real>
bool lift_new_pins(int splits, const std::vector<Solid>& solids, Particles<Real>& particles);
/// Those that are free and deeper inside than `shallow`, m. Contact would put them out by the nearest way: of
/// a table's top at its edge that may be down.
template <class Real>
bool lift_new_free_nodes(int splits, const std::vector<Solid>& solids, double shallow,
                         Particles<Real>& particles);

extern template bool lift_new_pins(int, const std::vector<Solid>&, Particles<float>&);
extern template bool lift_new_pins(int, const std::vector<Solid>&, Particles<double>&);
extern template bool lift_new_free_nodes(int, const std::vector<Solid>&, double, Particles<float>&);
extern template bool lift_new_free_nodes(int, const std::vector<Solid>&, double, Particles<double>&);

}  // namespace weft
