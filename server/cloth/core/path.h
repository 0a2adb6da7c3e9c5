#pragma once
#include <vector>

#include "cloth/core/description.h"

namespace weft {

/// Where a path of at least one point is at `time`, s: straight lines between its points, at rest before the
/// first and after the last, from where it begins anew if it loops.
Vec3 along_path(const std::vector<Waypoint>& path, double time, bool loops = false);
Pose along_path(const std::vector<PoseWaypoint>& path, double time, bool loops = false);

}  // namespace weft
