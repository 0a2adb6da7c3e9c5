#include "host/scene_messages.h"

#include <algorithm>
#include <cmath>

#include "cloth/shapes/triangle_mesh.h"
#include "host/tuning.h"

namespace weft::host {
namespace {

using nlohmann::json;

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Of a cloth that makes a difference between seen and unseen.
json relevance_json(const Relevance& relevance) {
  json message{{"unseen", relevance.unseen == Relevance::Unseen::sleep ? "sleep" : "coarse"}};
  if (std::isfinite(relevance.far)) message["far"] = relevance.far;
  return message;
}

json look_json(const scene::Look& look) {
  json message{{"weave", look.weave}, {"colour", look.colour}, {"weft", look.weft}, {"thread", look.thread}};
  if (!look.back.empty()) message["back"] = look.back;
  if (look.stripe) {
    message["stripe"] = {{"colour", look.stripe->colour},
                         {"width", look.stripe->width},
                         {"spacing", look.stripe->spacing},
                         {"bands", look.stripe->bands},
                         {"across", look.stripe->across}};
  }
  return message;
}

json cloths_json(const Simulation<float>& simulation, const std::vector<scene::Look>& looks,
                 const SceneState& state) {
  json cloths = json::array();
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const ClothDescription& cloth = simulation.cloths()[i].description();
    cloths.push_back({{"cloth", i},
                      {"name", cloth.name},
                      {"size", {cloth.size.x(), cloth.size.y()}},
                      {"base_cells", {cloth.base_cells.cols, cloth.base_cells.rows}},
                      {"min_level", cloth.min_level},
                      {"max_level", cloth.max_level},
                      {"material", material_json(state.materials[i], state.effects)},
                      {"pins", pins_json(cloth)}});
    if (cloth.relevance.unseen != Relevance::Unseen::step)
      cloths.back()["relevance"] = relevance_json(cloth.relevance);
    if (i < looks.size()) cloths.back()["look"] = look_json(looks[i]);
  }
  return cloths;
}

json quaternion_json(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

json length_json(double length) { return length; }
json length_json(const Vec3& lengths) { return vector_json(lengths); }

/// Adds what a shape is.
void describe(const PlaneDescription& plane, json& message) {
  message["shape"] = plane.kName;
  message["normal"] = vector_json(plane.normal);
}
void describe(const MeshDescription& mesh, json& message) {
  message["shape"] = mesh.convex ? mesh.kConvexName : mesh.kName;
  message["vertices"] = mesh.surface->list().vertices.size();
  message["triangles"] = mesh.surface->list().triangles.size();
  message["quaternion"] = quaternion_json(mesh.orientation);
}
template <class Description>
void describe(const Description& solid, json& message) {
  message["shape"] = solid.kName;
  std::apply([&](const auto&... each) { ((message[each.name] = length_json(solid.*each.member)), ...); },
             Description::lengths());
  message["quaternion"] = quaternion_json(solid.orientation);
}

json obstacle_json(const ObstacleDescription& obstacle, double friction) {
  json message{{"position", vector_json(obstacle.position)}, {"friction", friction}};
  std::visit([&](const auto& shape) { describe(shape, message); }, obstacle.shape);
  if (obstacle.body) message["mass"] = obstacle.body->mass;
  return message;
}

json zone_json(const WindZone& zone) {
  json message{{"position", vector_json(zone.position)},
               {"velocity", vector_json(zone.velocity)},
               {"edge", zone.edge}};
  if (const auto* box = std::get_if<BoxZone>(&zone.shape)) {
    message["shape"] = box->kName;
    message["size"] = vector_json(box->size);
    message["quaternion"] = quaternion_json(box->orientation);
  } else {
    const auto& sphere = std::get<SphereZone>(zone.shape);
    message["shape"] = sphere.kName;
    message["radius"] = sphere.radius;
  }
  return message;
}

/// To a micrometre.
std::string mesh_text(const TriangleMesh& mesh) {
  constexpr double kMicrometres = 1e6;
  json vertices = json::array(), triangles = json::array();
  for (const Vec3& vertex : mesh.list().vertices) {
    for (const double x : vertex) vertices.push_back(std::round(x * kMicrometres) / kMicrometres);
  }
  for (const std::array<int, 3>& triangle : mesh.list().triangles) {
    for (const int corner : triangle) triangles.push_back(corner);
  }
  return json({{"vertices", std::move(vertices)}, {"triangles", std::move(triangles)}}).dump();
}

json effects_json(const SimulationDescription& description) {
  json effects = json::array();
  for (const EffectDescription& effect : description.effects) {
    effects.push_back(name_of(effect));
  }
  return effects;
}

/// What keeps frames from the viewer; nullptr for nothing.
const char* limit_of(const Seat& seat, bool slow) {
  switch (seat.link.limit()) {
    case LinkKeeper::Limit::link:
      return "link";
    case LinkKeeper::Limit::client:
      return "client";
    case LinkKeeper::Limit::nothing:
      break;
  }
  return slow ? "server" : nullptr;
}

const char* state_of(const Cloth<float>& cloth) {
  if (cloth.frozen()) return "frozen";
  return cloth.asleep() ? "asleep" : "awake";
}

}  // namespace

json wind_json(const Wind& wind) {
  json message{{"direction", vector_json(wind.direction)}, {"speed", wind.speed}};
  if (wind.gusts.intensity > 0) {
    message["gusts"] = wind.gusts.intensity;
    message["time_scale"] = wind.gusts.time_scale;
  }
  if (wind.turbulence.intensity > 0) {
    message["turbulence"] = wind.turbulence.intensity;
    message["length_scale"] = wind.turbulence.length_scale;
  }
  for (const WindZone& zone : wind.zones) message["zones"].push_back(zone_json(zone));
  return message;
}

json pins_json(const ClothDescription& cloth) {
  json pins = json::array();
  for (const PinRegion& pin : cloth.pins) {
    pins.push_back({{"u", {pin.u_min, pin.u_max}}, {"v", {pin.v_min, pin.v_max}}});
  }
  return pins;
}

json pins_json(const std::vector<Cloth<float>>& cloths) {
  json pins = json::array();
  for (const Cloth<float>& cloth : cloths) pins.push_back(pins_json(cloth.description()));
  return pins;
}

json balls_json(const Colliders& colliders) {
  json balls = json::array();
  for (const Ball& ball : colliders.balls()) {
    const bool dynamic = ball.motion == BallDescription::Motion::dynamic;
    balls.push_back({{"ball", ball.id},
                     {"position", vector_json(ball.position)},
                     {"radius", ball.radius},
                     {"motion", dynamic ? "dynamic" : "kinematic"},
                     {"friction", ball.friction}});
  }
  return balls;
}

json frictions_json(const Colliders& colliders) {
  json frictions = json::array();
  for (const Obstacle& obstacle : colliders.obstacles()) frictions.push_back(obstacle.solid.friction);
  return frictions;
}

std::vector<std::shared_ptr<const std::string>> mesh_texts(const SimulationDescription& description) {
  std::vector<std::shared_ptr<const std::string>> texts;
  for (const ObstacleDescription& obstacle : description.obstacles) {
    const auto* mesh = std::get_if<MeshDescription>(&obstacle.shape);
    texts.push_back(mesh ? std::make_shared<const std::string>(mesh_text(*mesh->surface)) : nullptr);
  }
  return texts;
}

std::string scene_text(const scene::Scene& scene, const Simulation<float>& simulation,
                       const SceneState& state, const Seat& seat) {
  const SimulationDescription& description = simulation.description();
  const LevelPolicy& policy = description.level_policy;
  json message = {
      {"op", "scene"},
      {"name", scene.name},
      {"title", scene.title},
      {"seat", seat.token},
      {"f", simulation.step_count()},
      {"epoch", state.epoch},
      {"time", simulation.time()},
      {"dt", description.time_step},
      {"paused", state.paused},
      {"effects", effects_json(description)},
      {"parameters", parameters_json(state.effects)},
      {"tunable", tunable_json(state.effects)},
      {"material_tunable", material_tunable_json(state.effects)},
      {"wind", wind_json(simulation.wind())},
      {"balls", balls_json(simulation.colliders())},
      {"cloths", cloths_json(simulation, scene.looks, state)},
      {"level_policy",
       {{"thresholds", policy.thresholds}, {"levels", policy.levels}, {"hysteresis", policy.hysteresis}}},
      {"camera",
       {{"distance", scene.camera_distance},
        {"eye", vector_json(scene.camera_eye)},
        {"target", vector_json(scene.camera_target)},
        {"level", seat.levels}}}};
  if (!state.effects_off.empty()) message["effects_off"] = state.effects_off;
  for (std::size_t i = 0; i < description.obstacles.size(); ++i) {
    const Solid& solid = simulation.colliders().obstacles()[i].solid;
    message["obstacles"].push_back(obstacle_json(description.obstacles[i], solid.friction));
  }
  return message.dump();
}

std::string stats_text(const Simulation<float>& simulation, const StatsState& state, const Seat& seat,
                       const std::vector<int>& sent) {
  json cloths = json::array();
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const int level = std::min(sent[i], state.levels[i]);
    cloths.push_back({{"cloth", i},
                      {"level", level},
                      {"simulated_level", state.levels[i]},
                      {"nodes", simulation.description().cloths[i].base_cells.at(level).nodes()},
                      {"substeps", state.substeps[i]},
                      {"state", state_of(simulation.cloths()[i])},
                      {"distance", seat.distances[i]}});
    if (state.unseen[i]) cloths.back()["unseen"] = true;
  }
  json message = {{"op", "stats"},
                  {"f", simulation.step_count()},
                  {"time", simulation.time()},
                  {"step_ms", simulation.profile().total * 1e3},
                  {"rate", state.rate},
                  {"viewers", state.viewers},
                  {"dropped", seat.viewer->dropped()},
                  {"cloths", std::move(cloths)}};
  if (const char* limit = limit_of(seat, state.slow)) message["limit"] = limit;
  if (seat.link.coarser() > 0) message["coarser"] = seat.link.coarser();
  if (!state.quality.is_null()) message["quality"] = state.quality;
  if (!state.guard.is_null()) message["guard"] = state.guard;
  return message.dump();
}

}  // namespace weft::host
