#include "engines/engine_scene.h"

#include <numbers>

namespace weft::bench {

SimulationDescription describe(const EngineScene& scene, double structural,
                               const IntegratorDescription& integrator) {
  SimulationDescription description;
  ClothDescription cloth;
  cloth.size = {kSheetSide, kSheetSide};
  cloth.min_level = cloth.max_level = cloth.initial_level = scene.level;
  cloth.material.density = kDensity;
  cloth.material.structural = structural;
  cloth.material.bending = 0;
  cloth.material.damping = scene.damping * kDensity;
  cloth.perturbation = 1e-5;

  description.effects = {GravityEffect{}};
  if (scene.damping > 0) description.effects.emplace_back(DampingEffect{});
  const Quaternion horizontal(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  if (scene.name == 'H') {
    cloth.orientation = horizontal;
    cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  } else if (scene.name == 'B') {
    cloth.orientation = horizontal;
    cloth.position = {0, kBallRadius + 0.2, 0};
    BallDescription ball;
    ball.radius = kBallRadius;
    ball.friction = kBallFriction;
    description.balls = {ball};
  } else {
    cloth.pins = {{0, 1, 0, 0}};
    description.effects.emplace_back(AerodynamicsEffect{});
    description.wind = {{0, 0, -1}, kWindSpeed};
  }
  description.cloths = {cloth};
  description.integrator = integrator;
  description.time_step = kFrameTime;
  description.sleep_speed = 0;  // every step is measured
  return description;
}

}  // namespace weft::bench
