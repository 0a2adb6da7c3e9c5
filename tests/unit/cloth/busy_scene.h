#pragma once
/// Scenes for the tests of Simulation: a hung cloth, and one with something of everything.
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft::test {

inline BallDescription ball_at(const Vec3& position, double radius, const Vec3& velocity = {0, 0, 0}) {
  BallDescription ball;
  ball.position = position;
  ball.radius = radius;
  ball.velocity = velocity;
  return ball;
}

/// A cloth at level 4, hung by two corners under gravity with damping.
inline SimulationDescription hung_scene() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = 3;
  cloth.initial_level = 4;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.perturbation = 0.001;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  return scene;
}

/// The same in the wind, with a ball on its way through it.
inline SimulationDescription busy_scene() {
  SimulationDescription scene = hung_scene();
  scene.balls = {ball_at({0, 0, 1}, 0.3, {0, 0, -4})};
  scene.effects.push_back(AerodynamicsEffect{});
  scene.wind = {{0, 0, -1}, 2.0};
  return scene;
}

template <class Real>
void run(Simulation<Real>& simulation, int steps) {
  for (int i = 0; i < steps; ++i) simulation.step();
}

}  // namespace weft::test
