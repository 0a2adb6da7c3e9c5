#pragma once
#include <cstddef>

#include "cloth/core/vec3.h"

namespace weft {

/// A spring between a node and a place on a solid that yields, as a soft pin is.
struct BodySpring {
  std::size_t node;
  std::size_t solid;  ///< index
  Vec3 arm;           ///< of the place from the solid's centre, m; 0 of one that does not turn
  Vec3 apart;         ///< from the node to the place, m
  double stiffness;   ///< N/m
};

}  // namespace weft
