#include <stdexcept>

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/triangle_mesh.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kFriction{0, 10};
constexpr Range kMass{1e-6, 1e6, "kg"};
constexpr Range kSpin{-1e3, 1e3, "rad/s"};

/// Where it is, unless a path says so.
void read_position(Object& object, Vec3& position) {
  if (!object.has("path")) {
    object.require("position", "an array of 3 numbers, or a path");
  } else if (object.has("position")) {
    object.problem("position", "is given beside path; the path says where it is");
  }
  object.vector("position", position, kPosition);
}

/// Whether a skeleton's node carries it: "motion" is an object then.
bool is_carried(Object& object) {
  const json* motion = object.find("motion");
  return motion != nullptr && motion->is_object();
}

/// The node's way. What would move the collider otherwise is refused.
PosePath read_way_of_node(Object& object, MotionFiles& motions) {
  for (const char* key : {"path", "loop", "velocity", "spin"}) {
    if (object.has(key)) object.problem(key, "is given beside a motion's file, which says where it goes");
  }
  return read_motion(*object.find("motion"), object.path("motion"), object.report(), motions);
}

/// Whether it is dynamic.
bool read_dynamic(Object& object) {
  return !is_carried(object) && object.choice("motion", {"kinematic", "dynamic"}) == 1;
}

void carry(Object& object, MotionFiles& motions, BallDescription& ball) {
  object.vector("position", ball.position, kPosition);  // as seen from the node
  const PosePath way = read_way_of_node(object, motions);
  for (const PoseWaypoint& point : way.points)
    ball.path.push_back({point.time, point.pose.position + point.pose.orientation * ball.position});
  ball.loop = way.loop;
  if (!ball.path.empty()) ball.position = ball.path.front().position;
}

BallDescription read_ball(Object& object, MotionFiles& motions) {
  BallDescription ball;
  object.require("radius", kLength);
  object.number("radius", ball.radius, kLength);
  if (read_dynamic(object)) ball.motion = BallDescription::Motion::dynamic;
  object.number("mass", ball.mass, kMass);
  object.number("friction", ball.friction, kFriction);
  if (is_carried(object)) {
    carry(object, motions, ball);
    return ball;
  }
  read_position(object, ball.position);
  object.vector("velocity", ball.velocity, kVelocity);
  if (object.has("path")) {
    if (object.has("velocity")) object.problem("velocity", "is given beside path; the path says where it is");
    if (ball.motion == BallDescription::Motion::dynamic) {
      object.problem("path", "is given for a dynamic ball; only kinematic balls follow a path");
    }
  }
  WaypointPath path = read_path(object, "position");
  if (!path.points.empty()) ball.position = path.points.front().position;
  ball.path = std::move(path.points);
  ball.loop = path.loop;
  return ball;
}

void read_length(Object& object, const char* name, double& length) {
  object.require(name, kLength);
  object.number(name, length, kLength);
}
void read_length(Object& object, const char* name, Vec3& lengths) {
  object.require(name, "an array of 3 numbers");
  object.vector(name, lengths, kLength);
}

/// By its lengths and its turn.
template <class Description>
ObstacleDescription read_solid(Object& object) {
  ObstacleDescription obstacle;
  Description solid;
  std::apply([&](const auto&... each) { (read_length(object, each.name, solid.*each.member), ...); },
             Description::lengths());
  solid.orientation = read_turn(object, Quaternion::Identity());
  obstacle.shape = solid;
  read_pose_path(object, &solid.orientation, obstacle);
  return obstacle;
}

template <>
ObstacleDescription read_solid<PlaneDescription>(Object& object) {
  ObstacleDescription obstacle;
  PlaneDescription plane;
  object.direction("normal", plane.normal, kComponent);
  obstacle.shape = plane;
  read_pose_path(object, nullptr, obstacle);
  return obstacle;
}

ObstacleDescription read_surface(Object& object, bool convex, const SceneFolder& folder,
                                 const SimulationDescription& simulation) {
  std::size_t room = kMaxMeshTriangles;
  for (const ObstacleDescription& other : simulation.obstacles) {
    const auto* mesh = std::get_if<MeshDescription>(&other.shape);
    if (mesh != nullptr && mesh->surface != nullptr) room -= mesh->surface->list().triangles.size();
  }
  ObstacleDescription obstacle;
  const MeshDescription mesh = read_mesh(object, convex, room, folder);
  obstacle.shape = mesh;
  read_pose_path(object, &mesh.orientation, obstacle);
  return obstacle;
}

/// Its position and orientation are as seen from the node.
void carry(Object& object, MotionFiles& motions, ObstacleDescription& obstacle) {
  object.vector("position", obstacle.position, kPosition);
  PosePath way = read_way_of_node(object, motions);
  const Quaternion own = std::visit(
      [](const auto& shape) {
        if constexpr (requires { shape.orientation; }) return shape.orientation;
        return Quaternion::Identity();
      },
      obstacle.shape);
  for (PoseWaypoint& point : way.points) {
    point.pose.position += point.pose.orientation * obstacle.position;
    point.pose.orientation = (point.pose.orientation * own).normalized();
  }
  obstacle.path = std::move(way.points);
  obstacle.loop = way.loop;
}

/// What makes it a body: a mass, or that it flies.
void read_body(Object& object, ObstacleDescription& obstacle) {
  BodyDescription body;
  body.dynamic = read_dynamic(object);
  object.number("mass", body.mass, kMass);
  object.vector("velocity", body.velocity, kVelocity);
  object.vector("spin", body.spin, kSpin);
  if (body.dynamic && object.has("path")) {
    object.problem("path", "is given for a dynamic obstacle; only kinematic ones follow a path");
  }
  for (const char* key : {"velocity", "spin"}) {
    if (!body.dynamic && !is_carried(object) && object.has(key)) {
      object.problem(key, "is given for an obstacle whose motion is not \"dynamic\"");
    }
  }
  if (body.dynamic || object.has("mass")) obstacle.body = body;
}

/// Its vertices are counted from the centre of mass from now on, which stays where it is.
void centre(MeshDescription& mesh, ObstacleDescription& obstacle) {
  TriangleList list = mesh.surface->list();
  const Vec3 centre = mass_properties(list).centre;
  for (Vec3& vertex : list.vertices) vertex -= centre;
  mesh.surface = std::make_shared<const TriangleMesh>(list);
  obstacle.position += mesh.orientation * centre;
  for (PoseWaypoint& point : obstacle.path) point.pose.position += point.pose.orientation * centre;
}

/// What "type" may be: a ball, each shape but meshes, and these in two ways.
template <std::size_t... kIndex>
std::vector<const char*> collider_types(std::index_sequence<kIndex...>) {
  return {"ball", std::variant_alternative_t<kIndex, ObstacleShape>::kName..., MeshDescription::kConvexName,
          MeshDescription::kName};
}

/// "ball", "plane" or "box"
std::string one_of(const std::vector<const char*>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += '"' + std::string(names[i]) + '"';
  }
  return text;
}

/// Of the shape at this place in ObstacleShape.
template <std::size_t... kIndex>
ObstacleDescription read_solid_at(std::size_t place, Object& object, std::index_sequence<kIndex...>) {
  using Read = ObstacleDescription (*)(Object&);
  constexpr Read kReaders[] = {&read_solid<std::variant_alternative_t<kIndex, ObstacleShape>>...};
  return kReaders[place](object);
}

}  // namespace

void read_collider(const json& value, const std::string& path, Report& report, const SceneFolder& folder,
                   MotionFiles& motions, SimulationDescription& simulation) {
  Object object(value, path, report);
  constexpr std::size_t kSolids = std::variant_size_v<ObstacleShape> - 1;  // and meshes
  const auto solids = std::make_index_sequence<kSolids>();
  const std::vector<const char*> types = collider_types(solids);
  object.require("type", one_of(types));
  const int chosen = object.choice("type", types);
  if (chosen < 0) {
    object.ignore_rest();
    return;
  }
  if (chosen == 0) {
    simulation.balls.push_back(read_ball(object, motions));
    return;
  }
  const std::size_t place = static_cast<std::size_t>(chosen) - 1;
  ObstacleDescription obstacle = place < kSolids ? read_solid_at(place, object, solids)
                                                 : read_surface(object, place == kSolids, folder, simulation);
  const bool endless = std::holds_alternative<PlaneDescription>(obstacle.shape);
  if (!endless && is_carried(object)) {
    carry(object, motions, obstacle);
  } else {
    read_position(object, obstacle.position);
  }
  if (!obstacle.path.empty()) obstacle.position = obstacle.path.front().pose.position;
  object.number("friction", obstacle.friction, kFriction);
  if (!endless) read_body(object, obstacle);
  auto* mesh = std::get_if<MeshDescription>(&obstacle.shape);
  if (obstacle.body && mesh != nullptr && mesh->surface != nullptr) {
    try {
      centre(*mesh, obstacle);
    } catch (const std::invalid_argument& error) {
      object.problem(object.has("mass") ? "mass" : "motion",
                     "makes a body of a surface that " + std::string(error.what()));
    }
  }
  simulation.obstacles.push_back(obstacle);
}

}  // namespace weft::scene
