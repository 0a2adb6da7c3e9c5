// What the implicit methods' books of energy tell of each step.
#include <cmath>
#include <numbers>

#include "undamped.h"

namespace weft::test {
namespace {

// The books are exact: from step to step the energy changes by what was given back less what was lost, as
// gravity's work has its potential and nothing else does any. 1e-7 J is rounding: of positions in single
// precision, 6e-8 m, under the sheet's weight of 0.2 N, and of velocities, 1e-7 of 4 mJ, over a step's sums.
TEST(EnergyLedger, TellsEachStepsChange) {
  Simulation<float> simulation(scene_of({"silk-swing", Method::bdf2, 5, 60, 1, 2}));
  simulation.request_level(0, 5);
  simulation.step();
  double before = state_energy(simulation).sum(), lost = 0;
  for (int step = 1; step < 2 * 60; ++step) {
    simulation.step();
    const AdvanceReport& report = simulation.last_advance(0);
    const double now = state_energy(simulation).sum();
    EXPECT_NEAR(now - before, report.energy_given_back - report.energy_lost, 1e-7) << step;
    before = now;
    lost += report.energy_lost;
  }
  EXPECT_GT(lost, 1e-4) << "J; the swing has 4 mJ";
}

// A sheet of 0.05 kg that slides down a slope: gravity does m g sin(a) on its way, friction takes mu m g
// cos(a).
TEST(EnergyLedger, TellsTheWorkOfGravityAndOfFriction) {
  constexpr double kFriction = 0.3, kMass = 0.05;  // kg
  const double angle = 30 * std::numbers::pi / 180;
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.size = {0.5, 0.5};
  sheet.min_level = sheet.initial_level = sheet.max_level = 3;
  sheet.material.density = kMass / 0.25;
  sheet.orientation = Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitZ()) *
                                 Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths = {sheet};
  PlaneDescription slope;
  slope.normal = {-std::sin(angle), std::cos(angle), 0};
  ObstacleDescription ground;
  ground.shape = slope;
  ground.friction = kFriction;
  scene.obstacles = {ground};
  scene.effects = {GravityEffect{}};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 10; ++step) simulation.step();  // until it lies on the slope
  const Vec3 begin = simulation.centre(0);
  double work = 0, took = 0;
  for (int step = 0; step < 60; ++step) {
    simulation.step();
    work += simulation.last_advance(0).effects_work;
    took += simulation.last_advance(0).contact_took;
  }
  const double way = (simulation.centre(0) - begin).norm(), weight = kMass * standard_gravity().norm();
  EXPECT_GT(way, 0.5) << "m";
  EXPECT_NEAR(work, weight * std::sin(angle) * way, 0.01 * weight * way);
  EXPECT_NEAR(took, kFriction * weight * std::cos(angle) * way, 0.03 * weight * way);
}

}  // namespace
}  // namespace weft::test
