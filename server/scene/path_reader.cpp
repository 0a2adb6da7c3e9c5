#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// The owner's points, of which the last may have had no good time: read(object, point) reads the rest.
template <class Point, class Read>
std::vector<Point> read_points(Object& owner, Read read) {
  constexpr Range kTime{0, 1e6, "s"};
  std::vector<Point> path;
  owner.each("path", 1, kMaxWaypoints, [&](const json& value, const std::string& at) {
    Point point;
    Object object(value, at, owner.report());
    object.require("time", kTime);
    const bool timed = object.number("time", point.time, kTime);
    read(object, point);
    if (timed && !path.empty() && point.time <= path.back().time) {
      owner.report().refuse(value["time"], object.path("time"),
                            "later than the point before, at " + json(path.back().time).dump() + " s");
    }
    path.push_back(point);
  });
  return path;
}

/// Whether the path, which ends where it begins if `closed`, loops.
bool read_loop(Object& owner, bool has_path, bool closed) {
  bool loop = false;
  if (!owner.boolean("loop", loop) || !loop) return false;
  if (!has_path) owner.problem("loop", "is true without a path");
  if (!closed) owner.problem("loop", "is true, but the path does not end where it begins");
  return true;
}

}  // namespace

WaypointPath read_path(Object& owner, const char* place) {
  WaypointPath path;
  path.points = read_points<Waypoint>(owner, [&](Object& object, Waypoint& point) {
    object.require(place, "an array of 3 numbers");
    object.vector(place, point.position, kPosition);
  });
  const bool has_path = !path.points.empty();
  path.loop =
      read_loop(owner, has_path, !has_path || path.points.front().position == path.points.back().position);
  return path;
}

void read_pose_path(Object& owner, const Quaternion* orientation, ObstacleDescription& obstacle) {
  obstacle.path = read_points<PoseWaypoint>(owner, [&](Object& object, PoseWaypoint& point) {
    object.require("position", "an array of 3 numbers");
    object.vector("position", point.pose.position, kPosition);
    if (orientation != nullptr) point.pose.orientation = read_turn(object, *orientation);
  });
  const bool has_path = !obstacle.path.empty();
  const auto same = [](const Pose& a, const Pose& b) {
    return a.position == b.position && a.orientation.angularDistance(b.orientation) < 1e-6;
  };
  obstacle.loop =
      read_loop(owner, has_path, !has_path || same(obstacle.path.front().pose, obstacle.path.back().pose));
}

Quaternion read_turn(Object& object, const Quaternion& otherwise) {
  const json* orientation = object.find("orientation");
  if (orientation == nullptr) return otherwise;
  return read_orientation(*orientation, object.path("orientation"), object.report());
}

}  // namespace weft::scene
