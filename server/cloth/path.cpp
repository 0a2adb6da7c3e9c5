#include "cloth/path.h"

#include <algorithm>
#include <iterator>

namespace weft {

Vec3 along_path(const std::vector<Waypoint>& path, double time) {
  const auto next = std::find_if(path.begin(), path.end(), [&](const Waypoint& p) { return p.time > time; });
  if (next == path.begin()) return next->position;
  const Waypoint& before = *std::prev(next);
  if (next == path.end()) return before.position;
  return before.position +
         (time - before.time) / (next->time - before.time) * (next->position - before.position);
}

}  // namespace weft
