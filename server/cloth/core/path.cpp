#include "cloth/core/path.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace weft {
namespace {

/// The points before and after a time; the same one outside the path.
template <class Point>
struct Stretch {
  const Point& before;
  const Point& after;
  double share;  ///< of the way between them, 0..1
};

template <class Point>
Stretch<Point> stretch_at(const std::vector<Point>& path, double time, bool loops) {
  const double first = path.front().time, last = path.back().time;
  if (loops && time > last && last > first) time = first + std::fmod(time - first, last - first);
  const auto next = std::upper_bound(path.begin(), path.end(), time,
                                     [](double t, const Point& point) { return t < point.time; });
  if (next == path.begin()) return {*next, *next, 0};
  const Point& before = *std::prev(next);
  if (next == path.end()) return {before, before, 0};
  return {before, *next, (time - before.time) / (next->time - before.time)};
}

}  // namespace

Vec3 along_path(const std::vector<Waypoint>& path, double time, bool loops) {
  const auto [before, after, share] = stretch_at(path, time, loops);
  return before.position + share * (after.position - before.position);
}

Pose along_path(const std::vector<PoseWaypoint>& path, double time, bool loops) {
  const auto [before, after, share] = stretch_at(path, time, loops);
  return {before.pose.position + share * (after.pose.position - before.pose.position),
          before.pose.orientation.slerp(share, after.pose.orientation)};
}

}  // namespace weft
