#pragma once
#include "cloth/core/particles.h"
#include "cloth/sheet/cloth_description.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// Whether the sheet lies as none can: its structural springs are longer or shorter than at rest by 40 % on
/// average, as where the nodes lie on one line or anywhere.
template <class Real>
bool is_tangled(const Particles<Real>& particles, const Springs<Real>& springs);

/// Unfolds a tangled sheet of cloth.base_cells.at(level): the nodes of 2 x 2 base cells find their balance
/// first, under the springs alone, and so on from level to level, each beginning as the smooth sheet that the
/// one before it left. Found at once at its own level the balance is a lump of folds that hold one another, a
/// minimum of the energy as good as any; among so few nodes there is hardly one but the unfolded sheet's.
///
/// Held nodes stay where they are, and so does a free sheet's centre of mass; velocities stay as they were.
/// Solids are not seen: who is in one then is brought out in the next step.
template <class Real>
void unfold(Particles<Real>& particles, const ClothDescription& cloth, int level);

}  // namespace weft
