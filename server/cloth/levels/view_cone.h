#pragma once
#include "cloth/core/vec3.h"
#include "cloth/shapes/bounding_sphere.h"

namespace weft {

/// All that a viewer has in sight: a round cone from its eye on, without an end.
struct ViewCone {
  Vec3 eye{0, 0, 0};      ///< m
  Vec3 axis{0, 0, -1};    ///< where it looks; of length 1
  double half_angle = 0;  ///< between the axis and the cone's side, rad; (0, pi]

  /// Whether some of the sphere is inside, its rim counted, exactly: beside the cone it is the side that is
  /// nearest, behind it the eye (D. Eberly, Intersection of a Sphere and a Cone, Geometric Tools).
  bool touches(const BoundingSphere& sphere) const;
};

}  // namespace weft
