#pragma once
#include "cloth/core/particles.h"
#include "cloth/core/vec3.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// After split() (refine.h) of a torn cloth: new nodes whose means were taken across a wall are put where
/// their own side of it goes on, straight on from the two nodes before, or, where there is one alone, at most
/// `spacing` (m, along u and v) from it; they move as it does. A flake of new nodes alone stays where its
/// first one is. `torn` is of the fine level. Mass is not touched.
template <class Real>
void mend_split(const TornLinks& torn, const Vec2& spacing, Particles<Real>& fine);

/// merge_momentum() (refine.h) of a torn cloth: a fine node's momentum and mass go to those coarse nodes
/// around it that it still hangs together with, or to all if with none; a coarse node moves as what it got
/// does, so that the two sides of a tear do not slow each other. As each side's mass is a node more or less
/// from level to level, so is its momentum.
template <class Real>
void merge_torn_momentum(const Particles<Real>& fine, const TornLinks& torn, Particles<Real>& coarse);

extern template void mend_split(const TornLinks&, const Vec2&, Particles<float>&);
extern template void mend_split(const TornLinks&, const Vec2&, Particles<double>&);
extern template void merge_torn_momentum(const Particles<float>&, const TornLinks&, Particles<float>&);
extern template void merge_torn_momentum(const Particles<double>&, const TornLinks&, Particles<double>&);

}  // namespace weft
