#pragma once
#include "cloth/shapes/solid.h"

namespace weft {

/// A pinned node of a cloth that a solid which yields may meet in a step: nothing but its pin moves it, so it
/// holds the solid up as a collider does that goes as the pin goes.
struct PinnedNode {
  std::size_t solid = 0;  ///< that it may meet, index
  Solid node;             ///< a ball of no radius on the pin's way, with that solid's friction
};

}  // namespace weft
