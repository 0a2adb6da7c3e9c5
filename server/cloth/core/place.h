#pragma once
#include "cloth/core/particles.h"

namespace weft {

/// Places are multiples of this along each axis, m: a power of two, so that a move from one to the next
/// rounds nothing off positions of the usual digits. A cloth is at most half of it from its place when that
/// is chosen (server/cloth/DECISIONS.md).
inline constexpr double kPlaceGrid = 4;

/// The place for a cloth around this point of the world; 0 along an axis where that is not finite.
Vec3 place_near(const Vec3& point);

/// Once no node is within kPlaceGrid of the place along every axis, the place becomes the one near the middle
/// of the sheet, and the nodes stay where they are in the world. True if it moved.
template <class Real>
bool follow(Particles<Real>& particles);

extern template bool follow(Particles<float>&);
extern template bool follow(Particles<double>&);

}  // namespace weft
