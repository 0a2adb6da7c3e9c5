#pragma once
#include <optional>

#include "cloth/sheet/cloth_description.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// The cloth's springs as an implicit step of `h` seconds sees them, where they are stiffer than the scalar's
/// digits can tell: a system that holds their stiffness and the inertia of nodes of these masses has more
/// digits than that, and what is left of the inertia and of gravity is rounding. Material constants are
/// lowered until it has not. In single precision N cells along a length L then hang longer by 2e-8 g h^2 N^2
/// / L, a sheet of 1 mm at 60 Hz and level 4 by 1.5e-5. Nothing if they are as they should be.
template <class Real>
std::optional<Springs<Real>> softened_springs(const Springs<Real>& springs, const ClothDescription& cloth,
                                              const Field<Real>& mass, double h);

}  // namespace weft
