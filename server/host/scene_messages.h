#pragma once
/// The host's own messages of PROTOCOL.md section 3, as JSON.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/seat.h"
#include "scene/scene.h"

namespace weft::host {

/// What a scene message tells beside the simulation itself.
struct SceneState {
  std::uint32_t epoch = 1;
  bool paused = false;
  std::vector<std::string> effects_off;
  std::vector<EffectDescription> effects;  ///< as they are now
  std::vector<Material> materials;         ///< the cloths', as they are now
};

nlohmann::json wind_json(const Wind& wind);
nlohmann::json balls_json(const Colliders& colliders);
/// The obstacles' friction.
nlohmann::json frictions_json(const Colliders& colliders);
/// What holds one cloth now.
nlohmann::json pins_json(const ClothDescription& cloth);
/// What holds each of them.
nlohmann::json pins_json(const std::vector<Cloth<float>>& cloths);
/// What /v1/scenes/NAME/meshes/K answers for each of the obstacles; nullptr where that is no mesh.
std::vector<std::shared_ptr<const std::string>> mesh_texts(const SimulationDescription& description);
/// `scene`, as it is sent to `seat`.
std::string scene_text(const scene::Scene& scene, const Simulation<float>& simulation,
                       const SceneState& state, const Seat& seat);
/// `stats`, as it is sent to `seat` with its cloths at `sent` levels. `slow`: the clock runs behind real
/// time. `substeps`, `levels` (simulated ones) and `unseen` are by cloth; `quality` and `guard` are null if
/// there is nothing to tell of them.
struct StatsState {
  double rate = 1.0;
  bool slow = false;
  std::size_t viewers = 0;
  std::vector<int> substeps, levels;
  std::vector<bool> unseen;
  nlohmann::json quality, guard;
};
std::string stats_text(const Simulation<float>& simulation, const StatsState& state, const Seat& seat,
                       const std::vector<int>& sent);

}  // namespace weft::host
