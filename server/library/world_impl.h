#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cloth/core/parallel.h"
#include "cloth/world/simulation.h"
#include "scene/scene.h"
#include "weft/world.h"

namespace weft {

/// What a world holds: the scene, its simulation, and what was changed of its effects.
struct World::Impl {
  explicit Impl(scene::Scene described);

  /// Of a ball that is there; throws Error for one that is not.
  const weft::Ball& ball(std::uint32_t id) const;
  const weft::Obstacle& obstacle(std::size_t index) const {
    return simulation.colliders().obstacles()[index];
  }
  /// The simulation's effects are those of `effects` that are on.
  void compose();
  /// Effects, levels and all that is simulated are as the scene has them.
  void begin_anew();
  /// x, y, z of each node, row by row, and `offset` with them.
  std::span<const float> pack(std::size_t cloth, const VectorField<float>& field, const Vec3& offset);

  scene::Scene scene;
  Simulation<float> simulation;
  std::vector<EffectDescription> effects;  ///< the scene's, with their numbers as they are now
  std::vector<std::string> effects_off;    ///< names
  std::vector<int> seen_levels;            ///< by cloth, that look_from() chose last; empty: it never did
  std::vector<std::vector<float>> packed;  ///< by cloth
  std::optional<ThreadLimit> threads;
};

}  // namespace weft
