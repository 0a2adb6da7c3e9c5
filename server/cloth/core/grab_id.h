#pragma once
#include <cstdint>

namespace weft {

/// Of a hand on a cloth (Grab) or on a body (BodyHand), which are counted together.
using GrabId = std::uint32_t;

}  // namespace weft
