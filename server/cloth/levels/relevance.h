#pragma once
#include <limits>

#include "cloth/core/vec3.h"

namespace weft {

/// What becomes of a cloth that no viewer sees. Like LevelPolicy it is for whoever shows a simulation: the
/// simulation itself knows no viewers.
struct Relevance {
  enum class Unseen {
    step,    ///< stepped as if it were seen
    coarse,  ///< stepped at its lowest level: what is finer is lost, and grows anew when it is seen again
    sleep,   ///< its steps are left out, unless something moves it (Simulation::set_resting)
  };
  Unseen unseen = Unseen::step;
  double far = std::numeric_limits<double>::infinity();  ///< from where on it is too far to be seen, m
};

/// All within `radius` of a point, m.
struct BoundingSphere {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

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
