// A cloth at rest is left as it is, to the bit, and wakes when something comes.
#include <gtest/gtest.h>

#include <functional>

#include "busy_scene.h"
#include "faults.h"

namespace weft {
namespace {

using test::ball_at;
using test::hung_scene;
using test::run;

/// Level 3, without gravity: at rest from the start, so that it sleeps after Sleep::kQuietSteps.
SimulationDescription floating_scene() {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].initial_level = 3;
  scene.cloths[0].perturbation = 0;
  scene.effects = {AerodynamicsEffect{}};
  return scene;
}

template <class Real>
bool asleep(const Simulation<Real>& simulation) {
  return simulation.cloths()[0].asleep();
}

template <class Real>
Simulation<Real> sleeping(const SimulationDescription& scene) {
  Simulation<Real> simulation(scene);
  run(simulation, Sleep::kQuietSteps);
  EXPECT_TRUE(asleep(simulation));
  return simulation;
}

template <class Real>
class SleepOf : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SleepOf, Reals);

TYPED_TEST(SleepOf, BeginsAfterSixtyStepsAtRest) {
  for (const IntegratorDescription& integrator : test::default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    SimulationDescription scene = floating_scene();
    scene.integrator = integrator;
    Simulation<TypeParam> simulation(scene);
    run(simulation, Sleep::kQuietSteps - 1);
    EXPECT_FALSE(asleep(simulation));
    simulation.step();
    EXPECT_TRUE(asleep(simulation));
    EXPECT_GT(simulation.last_advance(0).substeps, 0);
    simulation.step();
    EXPECT_EQ(simulation.last_advance(0).substeps, 0);
  }
}

TYPED_TEST(SleepOf, AHungSheetComesToRestAndKeepsItsBits) {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].material.damping = 1;  // 10 a second
  Simulation<TypeParam> simulation(scene);
  int steps = 0;
  while (!asleep(simulation) && steps < 6000) {
    simulation.step();
    ++steps;
  }
  ASSERT_TRUE(asleep(simulation)) << "after 100 s";
  const Particles<TypeParam> before = simulation.cloths()[0].particles();
  run(simulation, 100'000);
  EXPECT_TRUE(asleep(simulation));
  EXPECT_TRUE(test::same_state(simulation.cloths()[0].particles(), before));
  EXPECT_EQ(simulation.step_count(), static_cast<std::uint64_t>(steps) + 100'000);
  // It was no mistake: the same sheet that never sleeps does not go anywhere either. Slower than 1e-4 m/s it
  // may still creep by 1e-4 m in a second.
  scene.sleep_speed = 0;
  Simulation<TypeParam> awake(scene);
  run(awake, steps + 60);
  EXPECT_FALSE(asleep(awake));
  EXPECT_LT(test::largest_difference(awake.cloths()[0].particles().position, before.position), 1e-4);
}

TEST(SleepTest, NeverWithASpeedOfZero) {
  SimulationDescription scene = floating_scene();
  scene.sleep_speed = 0;
  Simulation<double> simulation(scene);
  run(simulation, 200);
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, APendulumThatTurnsRoundIsAwake) {
  // Hung by its upper edge and released 0.01 rad aside: at most 0.04 m/s, and slower than 1e-4 m/s for a few
  // milliseconds at each turn.
  SimulationDescription scene = hung_scene();
  scene.cloths[0].initial_level = 3;
  scene.cloths[0].pins = {{0, 1, 0, 0}};
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(0.01, Vec3::UnitX()));
  scene.effects = {GravityEffect{}};
  Simulation<double> simulation(scene);
  for (int step = 0; step < 1200; ++step) {
    simulation.step();
    ASSERT_FALSE(asleep(simulation)) << step;
  }
}

/// After kQuietSteps steps at 60 Hz of particles that a test moves, at `speed` by its own account.
bool asleep_after(const std::function<Vec3(int step)>& place, double speed) {
  Particles<double> particles(Grid::with_nodes(3, 3));
  Sleep sleep(1e-4);
  for (int step = 1; step <= Sleep::kQuietSteps; ++step) {
    const Vec3 at = place(step);
    particles.position.x.at(1, 1) = at.x();
    particles.position.y.at(1, 1) = at.y();
    particles.position.z.at(1, 1) = at.z();
    sleep.stepped(speed, 1.0 / 60, particles, {});
  }
  return sleep.asleep();
}

TEST(SleepTest, WhatShakesOnThePlaceSleepsAndWhatGetsOnDoesNot) {
  // 0.1 mm a second is the threshold. Shaken by 0.045 mm to each side, a node goes 5.4 mm a second.
  EXPECT_TRUE(asleep_after([](int step) { return Vec3(step % 2 == 0 ? 4.5e-5 : -4.5e-5, 0, 0); }, 5.4e-3));
  EXPECT_FALSE(asleep_after([](int step) { return Vec3(0, step % 2 == 0 ? 5.5e-5 : -5.5e-5, 0); }, 6.6e-3));
  EXPECT_TRUE(asleep_after([](int step) { return Vec3(0, 0, 0.9e-4 * step / 60); }, 0.9e-4));
  EXPECT_FALSE(asleep_after([](int step) { return Vec3(0, 0, 1.1e-4 * step / 60); }, 1.1e-4));
  // What substeps press together has 0.2 m/s as each ends, and stays (S51a). As fast as 1 m/s it is about to
  // go.
  EXPECT_TRUE(asleep_after([](int) { return Vec3(0, 0, 0); }, 0.2));
  EXPECT_FALSE(asleep_after([](int) { return Vec3(0, 0, 0); }, 1));
}

// --- What wakes it ---

TEST(SleepTest, AnotherWindWakesTheSameDoesNot) {
  auto simulation = sleeping<float>(floating_scene());
  simulation.set_wind(simulation.wind());
  simulation.step();
  EXPECT_TRUE(asleep(simulation));
  const Particles<float> before = simulation.cloths()[0].particles();
  simulation.set_wind({{0, 0, -1}, 2.0});
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
  EXPECT_FALSE(test::same_bits(simulation.cloths()[0].particles().position, before.position));
}

TEST(SleepTest, GustsAndTurbulenceKeepItAwakeAZoneDoesNot) {
  // Along the sheet, so that a flat plate feels nothing: what keeps it awake is that the air changes.
  SimulationDescription scene = floating_scene();
  scene.wind = {{1, 0, 0}, 2.0};
  scene.wind.gusts.intensity = 0.2;
  Simulation<float> gusty(scene);
  run(gusty, 200);
  EXPECT_FALSE(asleep(gusty));
  Wind steady = gusty.wind();
  steady.gusts.intensity = 0;
  gusty.set_wind(steady);
  run(gusty, Sleep::kQuietSteps + 1);
  EXPECT_TRUE(asleep(gusty));
  scene.wind = {{1, 0, 0}, 2.0};
  scene.wind.turbulence.intensity = 1e-6;
  Simulation<float> turbulent(scene);
  run(turbulent, 200);
  EXPECT_FALSE(asleep(turbulent));
  scene.wind.turbulence.intensity = 0;
  scene.wind.zones = {{SphereZone{0.5}, {0, 0, 0}, {0, 3, 0}, 0.1}};
  auto simulation = sleeping<float>(scene);
  simulation.set_wind_zone(0, {0, 4, 0});
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, AnotherLevelOrIntegratorWakesIt) {
  auto simulation = sleeping<float>(floating_scene());
  simulation.request_level(0, 4);
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
  simulation = sleeping<float>(floating_scene());
  simulation.set_integrator(XpbdDescription{});
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, ResetAndWakeDo) {
  auto simulation = sleeping<float>(floating_scene());
  simulation.reset();
  EXPECT_FALSE(asleep(simulation));
  run(simulation, Sleep::kQuietSteps);
  EXPECT_TRUE(asleep(simulation));
  simulation.cloths()[0].wake();
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, ABallThatComesNearWakesIt) {
  auto simulation = sleeping<float>(floating_scene());  // 2 m square in the x-y plane
  const BallId ball = simulation.add_ball(ball_at({0, 0, 3}, 0.2));
  simulation.step();
  EXPECT_TRUE(asleep(simulation)) << "far";
  simulation.move_ball(ball, {0, 0, 2});
  simulation.step();
  EXPECT_TRUE(asleep(simulation)) << "moves, far";
  simulation.move_ball(ball, {0, 0, -2});
  simulation.step();
  EXPECT_FALSE(asleep(simulation)) << "through it within a step";
}

TEST(SleepTest, ABallThatIsPutIntoItOrTakenAwayWakesIt) {
  SimulationDescription scene = floating_scene();
  scene.effects = {DampingEffect{}};
  scene.cloths[0].material.damping = 1;
  auto simulation = sleeping<float>(scene);
  const BallId ball = simulation.add_ball(ball_at({0, 0, 0.19}, 0.2));
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
  // A resting ball does not keep it awake.
  int steps = 0;
  for (; !asleep(simulation) && steps < 6000; ++steps) simulation.step();
  ASSERT_TRUE(asleep(simulation)) << "after 100 s";
  run(simulation, 10);
  EXPECT_TRUE(asleep(simulation));
  simulation.remove_ball(ball);
  simulation.step();
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, AThrownBallWakesItWhenItArrives) {
  SimulationDescription scene = floating_scene();
  scene.balls = {ball_at({0, 0, 1}, 0.2)};
  auto simulation = sleeping<float>(scene);
  simulation.throw_ball(1, {0, 0, -1.5});
  // From 1 m the ball's surface has 0.8 m less the margin of 1 % of 2 m to go, 25 mm a step.
  for (int step = 1; step <= 31; ++step) simulation.step();
  EXPECT_TRUE(asleep(simulation));
  run(simulation, 2);
  EXPECT_FALSE(asleep(simulation));
}

TEST(SleepTest, ADynamicBallOnItSleepsWithItAndNotBefore) {
  SimulationDescription scene = floating_scene();
  BallDescription ball = ball_at({0, 0, 0.2}, 0.2);
  ball.motion = BallDescription::Motion::dynamic;  // no gravity: it stays
  scene.balls = {ball};
  Simulation<float> simulation(scene);
  run(simulation, 300);
  EXPECT_TRUE(asleep(simulation));
  EXPECT_TRUE(simulation.colliders().balls()[0].rest.asleep());
  EXPECT_EQ(simulation.colliders().balls()[0].position, Vec3(0, 0, 0.2));
  scene.balls[0].velocity = {0, 0, 1e-3};  // ten times the speed below which it sleeps
  Simulation<float> moves(scene);
  for (int step = 0; step < 300; ++step) {
    moves.step();
    ASSERT_FALSE(asleep(moves)) << step;  // 5 mm on: within the margin of 20 mm
  }
  EXPECT_FALSE(moves.colliders().balls()[0].rest.asleep());
}

TEST(SleepTest, APinThatHasYetToMoveKeepsItAwake) {
  // Gravity-free and at rest for the first two seconds, which are twice as long as it takes to fall asleep.
  SimulationDescription scene = floating_scene();
  scene.cloths[0].pins[0].path = {{2, {0, 0, 0}}, {2.5, {0, 0, 0.2}}};
  Simulation<float> simulation(scene);
  run(simulation, 120);
  EXPECT_FALSE(asleep(simulation));
  run(simulation, 30);
  EXPECT_NEAR(simulation.cloths()[0].particles().position_at(0, 0).z(), 0.2, 1e-6);
}

TEST(SleepTest, AFloorUnderItDoesNotKeepItAwake) {
  SimulationDescription scene = floating_scene();
  scene.cloths[0].position = {0, 1.005, 0};  // hangs 5 mm above: within the margin
  scene.obstacles = {{PlaneDescription{}, {0, 0, 0}, 0.5}};
  auto simulation = sleeping<float>(scene);
  run(simulation, 10);
  EXPECT_TRUE(asleep(simulation));
}

TEST(SleepTest, OnlyTheClothNearTheBallWakes) {
  SimulationDescription scene = floating_scene();
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].name = "other";
  scene.cloths[1].position = {5, 0, 0};
  auto simulation = sleeping<float>(scene);
  simulation.add_ball(ball_at({5, 0, 0.3}, 0.2, {0, 0, -12}));
  simulation.step();
  EXPECT_TRUE(simulation.cloths()[0].asleep());
  EXPECT_FALSE(simulation.cloths()[1].asleep());
  EXPECT_GT(simulation.report(1).nodes_in_contact, 0);
}

}  // namespace
}  // namespace weft
