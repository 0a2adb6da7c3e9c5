#pragma once
#include "cloth/core/vec3.h"

namespace weft {

/// All within `radius` of a point, m.
struct BoundingSphere {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

}  // namespace weft
