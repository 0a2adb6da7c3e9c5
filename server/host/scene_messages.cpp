#include "host/scene_messages.h"

#include <algorithm>

namespace weft::host {
namespace {

using nlohmann::json;

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json cloths_json(const Simulation<float>& simulation) {
  json cloths = json::array();
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const ClothDescription& cloth = simulation.cloths()[i].description();
    cloths.push_back({{"cloth", i},
                      {"name", cloth.name},
                      {"size", {cloth.size.x(), cloth.size.y()}},
                      {"base_cells", {cloth.base_cells.cols, cloth.base_cells.rows}},
                      {"min_level", cloth.min_level},
                      {"max_level", cloth.max_level},
                      {"pins", pins_json(cloth)}});
  }
  return cloths;
}

json quaternion_json(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

json obstacle_json(const ObstacleDescription& obstacle) {
  json message{{"position", vector_json(obstacle.position)}};
  if (const auto* plane = std::get_if<PlaneDescription>(&obstacle.shape)) {
    message["shape"] = plane->kName;
    message["normal"] = vector_json(plane->normal);
  } else if (const auto* box = std::get_if<BoxDescription>(&obstacle.shape)) {
    message["shape"] = box->kName;
    message["size"] = vector_json(box->size);
    message["quaternion"] = quaternion_json(box->orientation);
  } else {
    const auto& capsule = std::get<CapsuleDescription>(obstacle.shape);
    message["shape"] = capsule.kName;
    message["radius"] = capsule.radius;
    message["length"] = capsule.length;
    message["quaternion"] = quaternion_json(capsule.orientation);
  }
  return message;
}

json effects_json(const SimulationDescription& description) {
  json effects = json::array();
  for (const EffectDescription& effect : description.effects) {
    effects.push_back(std::visit([](const auto& e) { return e.kName; }, effect));
  }
  return effects;
}

const char* state_of(const Cloth<float>& cloth) {
  if (cloth.frozen()) return "frozen";
  return cloth.asleep() ? "asleep" : "awake";
}

}  // namespace

json wind_json(const Wind& wind) {
  json message{{"direction", vector_json(wind.direction)}, {"speed", wind.speed}};
  if (wind.gusts.intensity > 0) message["gusts"] = wind.gusts.intensity;
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
                     {"motion", dynamic ? "dynamic" : "kinematic"}});
  }
  return balls;
}

std::string scene_text(const scene::Scene& scene, const Simulation<float>& simulation,
                       const SceneState& state, const Seat& seat) {
  const SimulationDescription& description = simulation.description();
  const LevelPolicy& policy = description.level_policy;
  json message = {
      {"op", "scene"},
      {"name", scene.name},
      {"title", scene.title},
      {"f", simulation.step_count()},
      {"epoch", state.epoch},
      {"time", simulation.time()},
      {"dt", description.time_step},
      {"paused", state.paused},
      {"effects", effects_json(description)},
      {"wind", wind_json(simulation.wind())},
      {"balls", balls_json(simulation.colliders())},
      {"cloths", cloths_json(simulation)},
      {"level_policy",
       {{"thresholds", policy.thresholds}, {"levels", policy.levels}, {"hysteresis", policy.hysteresis}}},
      {"camera",
       {{"distance", scene.camera_distance},
        {"eye", vector_json(scene.camera_eye)},
        {"target", vector_json(scene.camera_target)},
        {"level", seat.levels}}}};
  for (const ObstacleDescription& obstacle : description.obstacles) {
    message["obstacles"].push_back(obstacle_json(obstacle));
  }
  return message.dump();
}

std::string stats_text(const Simulation<float>& simulation, const StatsState& state, const Seat& seat) {
  json cloths = json::array();
  for (std::size_t i = 0; i < seat.levels.size(); ++i) {
    const int level = std::min(seat.levels[i], state.levels[i]);
    cloths.push_back({{"cloth", i},
                      {"level", level},
                      {"simulated_level", state.levels[i]},
                      {"nodes", simulation.description().cloths[i].base_cells.at(level).nodes()},
                      {"substeps", state.substeps[i]},
                      {"state", state_of(simulation.cloths()[i])},
                      {"distance", seat.distances[i]}});
  }
  json message = {{"op", "stats"},
                  {"f", simulation.step_count()},
                  {"time", simulation.time()},
                  {"step_ms", simulation.profile().total * 1e3},
                  {"rate", state.rate},
                  {"viewers", state.viewers},
                  {"dropped", seat.viewer->dropped()},
                  {"cloths", std::move(cloths)}};
  if (!state.quality.is_null()) message["quality"] = state.quality;
  if (!state.guard.is_null()) message["guard"] = state.guard;
  return message.dump();
}

}  // namespace weft::host
