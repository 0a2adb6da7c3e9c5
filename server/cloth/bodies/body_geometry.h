#pragma once
#include <fcl/geometry/collision_geometry.h>

#include <map>
#include <memory>

#include "cloth/shapes/solid.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {

/// Solids as FCL has them. A mesh is laid out for it once, and kept.
class BodyGeometry {
 public:
  using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
  /// The solid's shape; nullptr of a ball and of a half-space, which are looked at otherwise.
  Geometry of(const Solid& solid);

 private:
  std::map<const TriangleMesh*, Geometry> surfaces_;
};

/// Where the solid's geometry is at the step's end.
fcl::Transform3d end_of(const Solid& solid);

}  // namespace weft
