// A scene in motion: the step, its clock, commands, reset, determinism, non-finite states. With balls:
// simulation_balls_test.cpp.
#include "cloth/world/simulation.h"

#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/sheet/diagnostics.h"

namespace weft {
namespace {

using test::ball_at;
using test::busy_scene;
using test::run;

template <class Real>
class SimulationOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SimulationOf, Scalars);

// --- Clock and profile ---

TYPED_TEST(SimulationOf, CountsTimeInWholeSteps) {
  Simulation<TypeParam> simulation(busy_scene());
  EXPECT_EQ(simulation.time(), 0.0);
  run(simulation, 7);
  EXPECT_EQ(simulation.step_count(), 7u);
  EXPECT_EQ(simulation.time(), 7.0 * (1.0 / 60.0));
}

TYPED_TEST(SimulationOf, ProfileHasItsStagesWithinTheWhole) {
  Simulation<TypeParam> simulation(busy_scene());
  run(simulation, 3);
  const StepProfile& profile = simulation.profile();
  EXPECT_GT(profile.forces, 0);
  EXPECT_GT(profile.contact, 0);
  EXPECT_GT(profile.check, 0);
  EXPECT_GE(profile.levels, 0);
  EXPECT_LE(profile.levels + profile.forces + profile.contact + profile.check, profile.total);
}

// --- Determinism ---

TYPED_TEST(SimulationOf, TheSameCallsGiveTheSameBits) {
  Simulation<TypeParam> one(busy_scene()), two(busy_scene());
  for (Simulation<TypeParam>* s : {&one, &two}) {
    run(*s, 20);
    s->request_level(0, 5);
    s->set_wind({{1, 0, 0}, 4.0});
    run(*s, 20);
    s->move_ball(1, {0.2, 0.1, 0});
    s->add_ball(ball_at({0.5, 0.5, 0.5}, 0.2, {0, 0, -2}));
    run(*s, 20);
    s->request_level(0, 3);
    run(*s, 20);
  }
  EXPECT_TRUE(test::same_state(one.cloths()[0].particles(), two.cloths()[0].particles()));
  EXPECT_EQ(one.colliders().balls()[1].position, two.colliders().balls()[1].position);
}

TYPED_TEST(SimulationOf, ResetGoesBackToTheVeryStart) {
  Simulation<TypeParam> simulation(busy_scene());
  const Particles<TypeParam> start = simulation.cloths()[0].particles();
  run(simulation, 30);
  const Particles<TypeParam> first = simulation.cloths()[0].particles();
  ASSERT_FALSE(test::same_state(start, first));
  simulation.request_level(0, 5);
  simulation.set_wind({{1, 0, 0}, 9.0});
  simulation.throw_ball(1, {0, 5, 0});
  simulation.add_ball({});
  run(simulation, 5);

  simulation.reset();
  EXPECT_EQ(simulation.step_count(), 0u);
  EXPECT_EQ(simulation.cloths()[0].level(), 4);
  EXPECT_EQ(simulation.wind().speed, 2.0);
  ASSERT_EQ(simulation.colliders().balls().size(), 1u);
  EXPECT_EQ(simulation.colliders().balls()[0].position, Vec3(0, 0, 1));
  EXPECT_TRUE(test::same_state(start, simulation.cloths()[0].particles()));
  run(simulation, 30);
  EXPECT_TRUE(test::same_state(first, simulation.cloths()[0].particles()));
  EXPECT_EQ(simulation.add_ball({}), 2u);  // ids, too, start anew
}

TYPED_TEST(SimulationOf, ResetForgetsALevelStillWaiting) {
  Simulation<TypeParam> simulation(busy_scene());
  simulation.request_level(0, 5);
  simulation.reset();
  simulation.step();
  EXPECT_EQ(simulation.cloths()[0].level(), 4);
}

// --- Commands ---

TEST(SimulationCommands, ALevelIsReachedInTheNextStep) {
  SimulationDescription scene = busy_scene();
  scene.integrator = SymplecticEulerDescription{};
  Simulation<double> simulation(scene);
  simulation.step();
  const int before = simulation.report(0).substeps;
  simulation.request_level(0, 6);
  EXPECT_EQ(simulation.cloths()[0].level(), 4);
  simulation.step();
  EXPECT_EQ(simulation.cloths()[0].level(), 6);
  EXPECT_EQ(simulation.report(0).level, 6);
  // The stiffest mode's frequency goes with 1/h: about four times the substeps for a quarter of the cell.
  EXPECT_NEAR(double(simulation.report(0).substeps) / before, 4.0, 0.3);
}

TEST(SimulationCommands, SubstepsCanBeFixedByTheScene) {
  SimulationDescription scene = busy_scene();
  scene.integrator = SymplecticEulerDescription{77, 0.9};
  Simulation<double> simulation(scene);
  simulation.step();
  EXPECT_EQ(simulation.report(0).substeps, 77);
}

TEST(SimulationCommands, AnIntegratorTakesOverInTheNextStepAndChangesNothingElse) {
  Simulation<double> changed(busy_scene()), other(busy_scene());
  run(changed, 5);
  const Particles<double> before = changed.cloths()[0].particles();
  changed.set_integrator(SymplecticEulerDescription{70});
  EXPECT_TRUE(test::same_state(before, changed.cloths()[0].particles()));
  changed.step();
  EXPECT_EQ(changed.report(0).substeps, 70);
  EXPECT_EQ(changed.step_count(), 6u);
  // There and back between two steps is as if nothing had been said: this method remembers nothing.
  run(other, 5);
  other.set_integrator(SymplecticEulerDescription{70});
  other.step();
  other.set_integrator(BackwardEulerDescription{});
  other.set_integrator(SymplecticEulerDescription{70});
  run(other, 3);
  run(changed, 3);
  EXPECT_TRUE(test::same_state(changed.cloths()[0].particles(), other.cloths()[0].particles()));
}

TYPED_TEST(SimulationOf, ResetGoesBackToTheDescriptionsIntegrator) {
  Simulation<TypeParam> simulation(busy_scene()), plain(busy_scene());
  simulation.set_integrator(XpbdDescription{7});
  run(simulation, 3);
  simulation.reset();
  run(simulation, 3);
  run(plain, 3);
  EXPECT_TRUE(test::same_state(simulation.cloths()[0].particles(), plain.cloths()[0].particles()));
}

TEST(SimulationCommands, WindTakesEffectInTheNextStep) {
  SimulationDescription scene = busy_scene();
  scene.balls.clear();
  scene.wind.speed = 0;
  scene.cloths[0].perturbation = 0;
  scene.cloths[0].pins.clear();
  Simulation<double> simulation(scene);
  simulation.step();
  EXPECT_EQ(linear_momentum(simulation.cloths()[0].particles()).z(), 0.0);
  simulation.set_wind({{0, 0, 1}, 2.0});
  simulation.step();
  EXPECT_GT(linear_momentum(simulation.cloths()[0].particles()).z(), 0.0);
}

TEST(SimulationCommands, BallsAreAddedMovedThrownAndRemoved) {
  SimulationDescription scene = busy_scene();
  scene.balls.clear();
  Simulation<double> simulation(scene);
  EXPECT_EQ(simulation.add_ball(ball_at({0, 5, 0}, 0.2)), 1u);
  EXPECT_TRUE(simulation.move_ball(1, {1, 5, 0}));
  simulation.step();
  EXPECT_EQ(simulation.colliders().find(1)->position, Vec3(1, 5, 0));
  EXPECT_TRUE(simulation.throw_ball(1, {60, 0, 0}));
  simulation.step();
  EXPECT_NEAR(simulation.colliders().find(1)->position.x(), 2, 1e-12);
  EXPECT_NEAR(simulation.colliders().find(1)->position.y(), 5 - 9.81 / 3600,
              1e-12);  // falls under the scene's gravity
  EXPECT_TRUE(simulation.remove_ball(1));
  EXPECT_FALSE(simulation.remove_ball(1));
  simulation.step();
  EXPECT_TRUE(simulation.healthy());
}

TEST(SimulationEffects, WithoutGravityNothingFalls) {
  SimulationDescription scene = busy_scene();
  scene.effects.clear();
  scene.balls.clear();
  scene.cloths[0].perturbation = 0;
  Simulation<double> simulation(scene);
  EXPECT_EQ(simulation.gravity(), Vec3(0, 0, 0));
  const Particles<double> start = simulation.cloths()[0].particles();
  run(simulation, 60);
  // Spring lengths of a flat sheet round by 1e-16; over a second nothing more may come of it.
  EXPECT_LT(test::largest_difference(start.position, simulation.cloths()[0].particles().position), 1e-12);
}

// --- Reports ---

TEST(SimulationReport, OfASheetAtItsStart) {
  SimulationDescription scene = busy_scene();
  scene.cloths[0].perturbation = 0;
  scene.cloths[0].position = {1, 2, 3};
  scene.cloths[0].velocity = {3, 0, 4};
  scene.cloths[0].pins.clear();
  const Simulation<double> simulation(scene);
  EXPECT_LT((simulation.centre(0) - Vec3(1, 2, 3)).norm(), 1e-13);
  const ClothReport report = simulation.report(0);
  EXPECT_EQ(report.level, 4);
  EXPECT_NEAR(report.kinetic_energy, 0.5 * 0.4 * 25, 1e-12);
  EXPECT_NEAR(report.potential_energy, 0.4 * 9.81 * 2, 1e-11);  // m g h; springs at rest
  EXPECT_LT(report.strain.max, 1e-14);
}

TEST(SimulationReport, EnergyOfAnUndampedSwingStaysWithinASmallShare) {
  // Hung by an edge and released at 0.3 rad with springs only: symplectic Euler keeps the energy within
  // O(dt).
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = 3;
  cloth.initial_level = 3;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  cloth.pins = {{0, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}};
  scene.integrator = SymplecticEulerDescription{};
  Simulation<double> simulation(scene);
  const auto energy = [&] {
    const ClothReport report = simulation.report(0);
    return report.kinetic_energy + report.potential_energy;
  };
  const double start = energy();
  double moved = 0, drift = 0;
  for (int step = 0; step < 300; ++step) {
    simulation.step();
    drift = std::max(drift, std::abs(energy() - start));
    moved = std::max(moved, simulation.report(0).kinetic_energy);
  }
  // 0.4 kg with its centre 1 m below the hinge falls by 1 - cos 0.3: 0.175 J goes to and fro.
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(drift, 0.02 * moved);
}

// --- Several cloths, level changes ---

TEST(SimulationCloths, DoNotDisturbEachOther) {
  SimulationDescription pair = busy_scene();
  pair.balls.clear();
  SimulationDescription alone = pair;
  ClothDescription other = pair.cloths[0];
  other.position = {5, 0, 0};
  other.base_cells = {2, 1};
  other.size = {2, 1};
  pair.cloths.push_back(other);
  Simulation<float> with(pair), without(alone);
  run(with, 10);
  run(without, 10);
  EXPECT_TRUE(test::same_state(with.cloths()[0].particles(), without.cloths()[0].particles()));
  with.request_level(1, 3);
  with.step();
  EXPECT_EQ(with.cloths()[0].level(), 4);
  EXPECT_EQ(with.cloths()[1].level(), 3);
  EXPECT_EQ(with.cloths()[1].particles().grid(), (BaseCells{2, 1}.at(3)));
}

TYPED_TEST(SimulationOf, StaysSoundThroughLevelChangesSlow) {
  // Up and down every sixth of a second, hung in the wind with a ball going through; cells twice as high as
  // wide.
  SimulationDescription scene = busy_scene();
  scene.cloths[0].base_cells = {2, 1};
  Simulation<TypeParam> simulation(scene);
  const int levels[] = {4, 5, 6, 5, 4, 3};
  for (int step = 0; step < 60; ++step) {
    simulation.request_level(0, levels[step / 10]);
    simulation.step();
    ASSERT_TRUE(simulation.healthy());
    ASSERT_EQ(simulation.cloths()[0].particles().grid(), (BaseCells{2, 1}.at(levels[step / 10])));
    // 0.4 kg cannot have fallen faster than 1 s of g, nor been carried much beyond the ball's 4 m/s.
    ASSERT_LT(simulation.report(0).kinetic_energy, 0.5 * 0.4 * 9.81 * 9.81) << step;
  }
}

}  // namespace
}  // namespace weft
