#include "cli/seen_bodies.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "cloth/bodies/collider_description.h"

namespace weft::cli {
namespace {

using nlohmann::json;

Vec3 vector_of_json(const json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

/// w, x, y, z.
template <class Values>
Quaternion quaternion_of(const Values& value) {
  return Quaternion(double(value.at(0)), double(value.at(1)), double(value.at(2)), double(value.at(3)))
      .normalized();
}

TriangleList mesh_of_text(const std::string& text) {
  const json mesh = json::parse(text, nullptr, false);
  if (mesh.is_discarded()) throw std::runtime_error("the server's mesh of an obstacle is no JSON");
  const auto vertices = mesh.at("vertices").get<std::vector<double>>();
  const auto corners = mesh.at("triangles").get<std::vector<int>>();
  TriangleList list;
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) list.vertices.emplace_back(&vertices[i]);
  const auto count = static_cast<int>(list.vertices.size());
  if (std::any_of(corners.begin(), corners.end(), [&](int corner) { return corner < 0 || corner >= count; }))
    throw std::runtime_error("the server's mesh of an obstacle has a corner that is none of its vertices");
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    list.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return list;
}

void read_length(const json& value, double& length) { length = value.get<double>(); }
void read_length(const json& value, Vec3& lengths) { lengths = vector_of_json(value); }

/// The shape if it is of this kind, which needs no mesh.
template <class Description>
std::optional<Shape> as(const json& obstacle) {
  Description description;
  if constexpr (requires { Description::lengths(); }) {
    std::apply(
        [&](const auto&... each) { (read_length(obstacle.at(each.name), description.*each.member), ...); },
        Description::lengths());
  }
  return description.shape();
}

/// Looks the shape's name up among the kinds that there are; nothing for meshes and what is not known.
template <std::size_t kKind = 0>
std::optional<Shape> plain_shape(const json& obstacle) {
  if constexpr (kKind == std::variant_size_v<ObstacleShape>) {
    return {};
  } else {
    using Description = std::variant_alternative_t<kKind, ObstacleShape>;
    if constexpr (!std::is_same_v<Description, MeshDescription>) {
      if (obstacle.at("shape") == Description::kName) return as<Description>(obstacle);
    }
    return plain_shape<kKind + 1>(obstacle);
  }
}

}  // namespace

SeenBodies::SeenBodies(const json& scene, const protocol::Frame& first, const GetMesh& get_mesh)
    : balls_(first.balls.size()) {
  for (const protocol::FrameBall& ball : first.balls) {
    meshes_.push_back(body_mesh("ball-" + std::to_string(ball.id), Sphere{ball.radius}));
    poses_.emplace_back();
    ids_.push_back(ball.id);
  }
  const auto obstacles = scene.find("obstacles");
  if (obstacles == scene.end()) return;
  for (std::size_t i = 0; i < obstacles->size(); ++i) add_obstacle((*obstacles)[i], i, get_mesh);
}

void SeenBodies::add_obstacle(const json& obstacle, std::size_t index, const GetMesh& get_mesh) {
  const std::string name = "obstacle-" + std::to_string(index), shape = obstacle.at("shape");
  if (const std::optional<Shape> plain = plain_shape(obstacle)) {
    meshes_.push_back(body_mesh(name, *plain));
  } else if (shape == MeshDescription::kName || shape == MeshDescription::kConvexName) {
    meshes_.push_back(body_mesh(name, mesh_of_text(get_mesh(index))));
  } else {
    return;
  }
  const Quaternion turned = shape == PlaneDescription::kName
                                ? turn_from_y(vector_of_json(obstacle.at("normal")))
                                : quaternion_of(obstacle.at("quaternion"));
  poses_.push_back({vector_of_json(obstacle.at("position")), turned});
  ids_.push_back(static_cast<std::uint32_t>(index));
}

const std::vector<Pose>& SeenBodies::poses(const protocol::Frame& frame) {
  const auto place = [](const std::array<float, 3>& p) { return Vec3(p[0], p[1], p[2]); };
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (i < balls_) {
      const auto ball = std::find_if(frame.balls.begin(), frame.balls.end(),
                                     [&](const protocol::FrameBall& each) { return each.id == ids_[i]; });
      if (ball != frame.balls.end()) poses_[i].position = place(ball->position);
    } else {
      const auto moved =
          std::find_if(frame.obstacles.begin(), frame.obstacles.end(),
                       [&](const protocol::FrameObstacle& each) { return each.obstacle == ids_[i]; });
      if (moved != frame.obstacles.end())
        poses_[i] = {place(moved->position), quaternion_of(moved->quaternion)};
    }
  }
  return poses_;
}

}  // namespace weft::cli
