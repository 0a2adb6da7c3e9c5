#pragma once
#include <cstdint>

#include "cloth/core/particles.h"
#include "cloth/sheet/cloth_description.h"

namespace weft {

/// The cloth as its description puts it, at `level`: flat about `position`, or folded over if it is sewn, or
/// at `nodes`; all of it moves with `velocity`. Its place is the one near `position`, or its middle node.
/// Masses are not set. std::invalid_argument if there are `nodes`, but not one for each of the level's.
template <class Real>
Particles<Real> start(const ClothDescription& description, int level);

/// Moves each free node by up to the description's `perturbation` along the sheet's normal. Every node draws,
/// pinned or not, so that pins do not change what the others get.
template <class Real>
void perturb(const ClothDescription& description, std::uint64_t seed, Particles<Real>& particles);

extern template Particles<float> start(const ClothDescription&, int);
extern template Particles<double> start(const ClothDescription&, int);
extern template void perturb(const ClothDescription&, std::uint64_t, Particles<float>&);
extern template void perturb(const ClothDescription&, std::uint64_t, Particles<double>&);

}  // namespace weft
