#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kFriction{0, 10};

std::vector<Waypoint> read_ball_path(Object& ball) {
  for (const char* key : {"position", "velocity"}) {
    if (ball.has(key)) ball.problem(key, "is given beside path; the path says where the ball is");
  }
  return read_path(ball, "position");
}

BallDescription read_ball(Object& object) {
  constexpr Range kMass{1e-6, 1e6, "kg"};
  BallDescription ball;
  object.require("radius", kLength);
  object.number("radius", ball.radius, kLength);
  if (object.choice("motion", {"kinematic", "dynamic"}) == 1) ball.motion = BallDescription::Motion::dynamic;
  object.number("mass", ball.mass, kMass);
  object.number("friction", ball.friction, kFriction);
  if (object.has("path")) {
    if (ball.motion == BallDescription::Motion::dynamic) {
      object.problem("path", "is given for a dynamic ball; only kinematic balls follow a path");
    }
    ball.path = read_ball_path(object);
    if (!ball.path.empty()) ball.position = ball.path.front().position;
  } else {
    object.require("position", "an array of 3 numbers, or a path");
  }
  object.vector("position", ball.position, kPosition);
  object.vector("velocity", ball.velocity, kVelocity);
  return ball;
}

ObstacleDescription read_plane(Object& object) {
  ObstacleDescription obstacle;
  PlaneDescription plane;
  object.direction("normal", plane.normal, kComponent);
  obstacle.shape = plane;
  return obstacle;
}

Quaternion read_turn(Object& object) {
  const json* orientation = object.find("orientation");
  if (orientation == nullptr) return Quaternion::Identity();
  return read_orientation(*orientation, object.path("orientation"), object.report());
}

ObstacleDescription read_box(Object& object) {
  ObstacleDescription obstacle;
  BoxDescription box;
  object.require("size", "an array of 3 numbers");
  object.vector("size", box.size, kLength);
  box.orientation = read_turn(object);
  obstacle.shape = box;
  return obstacle;
}

ObstacleDescription read_capsule(Object& object) {
  ObstacleDescription obstacle;
  CapsuleDescription capsule;
  object.require("radius", kLength);
  object.number("radius", capsule.radius, kLength);
  object.require("length", kLength);
  object.number("length", capsule.length, kLength);
  capsule.orientation = read_turn(object);
  obstacle.shape = capsule;
  return obstacle;
}

}  // namespace

std::vector<Waypoint> read_path(Object& owner, const char* place) {
  constexpr Range kTime{0, 1e6, "s"};
  std::vector<Waypoint> path;
  owner.each("path", 1, kMaxWaypoints, [&](const json& value, const std::string& at) {
    Waypoint point;
    Object object(value, at, owner.report());
    object.require("time", kTime);
    const bool timed = object.number("time", point.time, kTime);
    object.require(place, "an array of 3 numbers");
    object.vector(place, point.position, kPosition);
    if (timed && !path.empty() && point.time <= path.back().time) {
      owner.report().refuse(value["time"], object.path("time"),
                            "later than the point before, at " + json(path.back().time).dump() + " s");
    }
    path.push_back(point);
  });
  return path;
}

void read_collider(const json& value, const std::string& path, Report& report,
                   SimulationDescription& simulation) {
  Object object(value, path, report);
  object.require("type", "\"ball\", \"plane\", \"box\" or \"capsule\"");
  const int type = object.choice(
      "type", {"ball", PlaneDescription::kName, BoxDescription::kName, CapsuleDescription::kName});
  if (type < 0) {
    object.ignore_rest();
    return;
  }
  if (type == 0) {
    simulation.balls.push_back(read_ball(object));
    return;
  }
  ObstacleDescription obstacle = type == 1   ? read_plane(object)
                                 : type == 2 ? read_box(object)
                                             : read_capsule(object);
  object.require("position", "an array of 3 numbers");
  object.vector("position", obstacle.position, kPosition);
  object.number("friction", obstacle.friction, kFriction);
  simulation.obstacles.push_back(obstacle);
}

}  // namespace weft::scene
