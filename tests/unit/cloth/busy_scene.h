#pragma once
/// A scene with something of everything, for the tests of Simulation.
#include "cloth/simulation.h"
#include "fixtures.h"

namespace weft::test {

inline BallDescription ball_at(const Vec3& position, double radius, const Vec3& velocity = {0, 0, 0}) {
  BallDescription ball;
  ball.position = position;
  ball.radius = radius;
  ball.velocity = velocity;
  return ball;
}

/// A cloth hung by two corners in the wind, level 4, with a ball on its way through it.
inline SimulationDescription busy_scene() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = 3;
  cloth.initial_level = 4;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.perturbation = 0.001;
  scene.cloths = {cloth};
  scene.balls = {ball_at({0, 0, 1}, 0.3, {0, 0, -4})};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.wind = {{0, 0, -1}, 2.0};
  return scene;
}

template <class Real>
void run(Simulation<Real>& simulation, int steps) {
  for (int i = 0; i < steps; ++i) simulation.step();
}

}  // namespace weft::test
