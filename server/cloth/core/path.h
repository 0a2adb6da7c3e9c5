#pragma once
#include <vector>

#include "cloth/core/vec3.h"

namespace weft {

/// A point passed at a time; linear between points, at rest before the first and after the last.
struct Waypoint {
  double time = 0.0;  ///< s, ascending
  Vec3 position{0.0, 0.0, 0.0};
};

/// Where something is and how it is turned.
struct Pose {
  Vec3 position{0.0, 0.0, 0.0};
  Quaternion orientation = Quaternion::Identity();  ///< local to world
};
/// A pose taken at a time; between two points straight and turning at an even rate the shorter way round, at
/// rest before the first and after the last.
struct PoseWaypoint {
  double time = 0.0;  ///< s, ascending
  Pose pose;
};

/// Where a path of at least one point is at `time`, s: straight lines between its points, at rest before the
/// first and after the last, from where it begins anew if it loops.
Vec3 along_path(const std::vector<Waypoint>& path, double time, bool loops = false);
Pose along_path(const std::vector<PoseWaypoint>& path, double time, bool loops = false);

}  // namespace weft
