// Wind that presses cloth at rest onto what stands behind it, or lies there.
#include <gtest/gtest.h>

#include <cmath>

#include "draws.h"
#include "fixtures.h"
#include "methods.h"
#include "undamped.h"

namespace weft::test {
namespace {

/// A sheet of 0.3 to 1 m, and a ball or a box behind it in a wind of 6 to 14 m/s: by millimetres if the sheet
/// hangs by its top, else by 5 to 40 cm.
SimulationDescription pressed(Draws& draws, const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription sheet;
  const double side = draws.between(0.3, 1), half = side * draws.between(0.1, 0.3);
  sheet.size = {side, side};
  sheet.material =
      find_fabric(draws.one_of(std::array{"silk", "cotton", "canvas", "denim", "wool"}))->material;
  sheet.min_level = sheet.initial_level = sheet.max_level = draws.one_of(std::array{4, 5});
  const bool hangs = draws.one_of(std::array{true, false});
  if (hangs) sheet.pins = {{0, 1, 0, 0}};
  scene.cloths = {sheet};
  const double gap = hangs ? draws.between(0.001, 0.01) : draws.between(0.05, 0.4);
  ObstacleDescription solid;
  solid.position = {0, 0, -half - gap};
  if (draws.one_of(std::array{true, false})) {
    solid.shape = BoxDescription{Vec3::Constant(2 * half)};
    scene.obstacles = {solid};
  } else {
    BallDescription ball;
    ball.position = solid.position;
    ball.radius = half;
    scene.balls = {ball};
  }
  scene.effects = {DampingEffect{}, AerodynamicsEffect{}};
  scene.wind.direction = {0, 0, -1};
  scene.wind.speed = draws.between(6, 14);
  scene.time_step = 1.0 / draws.one_of(std::array{30, 60, 120});
  scene.integrator = integrator;
  return scene;
}

struct InWind {
  double energy = 0;  ///< the most of the cloth, J
  bool met = false;   ///< something
};

InWind most_in(const SimulationDescription& scene) {
  constexpr double kBlown = 0.3;  // s
  Simulation<float> simulation(scene);
  InWind most;
  for (double time = 0; time < kBlown; time += scene.time_step) {
    simulation.step();
    most.energy = std::max(most.energy, state_energy(simulation).sum());
    most.met = most.met || simulation.report(0).nodes_in_contact > 0;
  }
  return most;
}

class PressedByWind : public ImplicitMethod {};

// What stands firm gives it nothing: it has no more energy than the wind gives it where nothing stands, but
// for rounding.
TEST_P(PressedByWind, HasItsEnergyFromTheWindAlone) {
  Draws draws;
  int met = 0;
  for (int k = 0; k < sample(48); ++k) {
    SimulationDescription scene = pressed(draws, integrator());
    const InWind beside = most_in(scene);
    scene.balls.clear();
    scene.obstacles.clear();
    const InWind alone = most_in(scene);
    EXPECT_LT(beside.energy, 1.001 * alone.energy) << k;
    met += beside.met ? 1 : 0;
  }
  EXPECT_GT(met, sample(48) * 3 / 4);
}

// Steps are hardly made again for a body that it is pressed onto: in 5 of 192 such scenes drawn otherwise.
TEST_P(PressedByWind, PushesABody) {
  Draws draws;
  int redone = 0;
  for (int k = 0; k < sample(48); ++k) {
    SimulationDescription scene = pressed(draws, integrator());
    const double mass = std::pow(10, draws.between(-0.5, 0.6));
    for (BallDescription& ball : scene.balls) {
      ball.mass = mass;
      ball.motion = BallDescription::Motion::dynamic;
    }
    for (ObstacleDescription& obstacle : scene.obstacles) obstacle.body = BodyDescription{.mass = mass};
    Simulation<float> simulation(scene);
    for (int step = 0; step < 60; ++step) simulation.step();
    redone += simulation.cloths()[0].guard_counters().all_redone() > 0 ? 1 : 0;
  }
  EXPECT_LE(redone, sample(48) / 12);
}

INSTANTIATE_TEST_SUITE_P(Implicit, PressedByWind, ::testing::ValuesIn(kImplicitMethods), name_of_case);
INSTANTIATE_TEST_SUITE_P(Nightly, PressedByWind, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
