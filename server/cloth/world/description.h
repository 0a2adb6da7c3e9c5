#pragma once
/// What a simulation is made from: plain values, checked by whoever fills them (server/scene for files).
/// Field names equal the names in scene files.
#include <cstdint>
#include <vector>

#include "cloth/air/wind.h"
#include "cloth/bodies/collider_description.h"
#include "cloth/core/effect_description.h"
#include "cloth/integrators/integrator_description.h"
#include "cloth/levels/level_policy.h"
#include "cloth/sheet/cloth_description.h"

namespace weft {

struct SimulationDescription {
  std::vector<ClothDescription> cloths;
  std::vector<BallDescription> balls;
  std::vector<ObstacleDescription> obstacles;
  std::vector<EffectDescription> effects;
  Wind wind;
  IntegratorDescription integrator = Bdf2Description{};
  double time_step = 1.0 / 60.0;  ///< s
  /// A cloth none of whose nodes has got on faster for 60 steps, with nothing moving near it, sleeps: it is
  /// left as it is until something comes (Sleep), and so the bodies on it (islands.h), m/s; 0: never.
  double sleep_speed = 1e-4;
  LevelPolicy level_policy;
  std::uint64_t seed = 1;
};

}  // namespace weft
