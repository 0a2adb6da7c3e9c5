#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A cloth has been merged (refine.h) from `fine` to `coarse`, once or several times. The chords between the
/// nodes that stay may pass a thin solid on its other side, where contact would then let the cloth out: over
/// a rail of 2 cm, chords of 12 cm run from the node on it to those that hang below it. Where that is so, or
/// a chord is so deep inside that it might be, the free nodes at its ends are moved out, along the surface's
/// normal next to where the finer sheet was, until the chord is above the plane that touches the solid there.
/// What lies on the right side is left to contact.
///
/// The solids, as the step begins, are as seen from the particles' place. Returns whether a node has moved.
template <class Real>
bool keep_sides(const Particles<Real>& fine, const std::vector<Solid>& solids, Particles<Real>& coarse);

extern template bool keep_sides(const Particles<float>&, const std::vector<Solid>&, Particles<float>&);
extern template bool keep_sides(const Particles<double>&, const std::vector<Solid>&, Particles<double>&);

}  // namespace weft
