#pragma once
#include <vector>

#include "cloth/description.h"

namespace weft {

/// Where a path of at least one point is at `time`, s: straight lines between its points, at rest before the
/// first and after the last.
Vec3 along_path(const std::vector<Waypoint>& path, double time);

}  // namespace weft
