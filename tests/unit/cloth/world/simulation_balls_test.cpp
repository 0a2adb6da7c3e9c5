// A scene in motion with balls: contact after whole steps, momentum, fast balls, what it costs without one.
#include <gtest/gtest.h>

#include <numbers>

#include <algorithm>
#include <limits>

#include "busy_scene.h"
#include "cloth/sheet/diagnostics.h"

namespace weft {
namespace {

using test::ball_at;
using test::busy_scene;
using test::each_node;
using test::run;

template <class Real>
class SimulationWithABall : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SimulationWithABall, Scalars);

TYPED_TEST(SimulationWithABall, NoFreeNodeIsInsideABallAfterAnyStep) {
  SimulationDescription scene = busy_scene();
  scene.cloths[0].initial_level = 5;
  Simulation<TypeParam> simulation(scene);
  int contacts = 0;
  for (int step = 0; step < 60; ++step) {
    simulation.step();
    const Ball& ball = simulation.colliders().balls()[0];
    const Particles<TypeParam>& particles = simulation.cloths()[0].particles();
    each_node(particles.grid(), [&](int r, int c) {
      if (particles.inverse_mass.at(r, c) == 0) return;
      const double distance = (particles.position_at(r, c) - ball.position).norm();
      // Positions of about 1 m round by 6e-8 in float.
      ASSERT_GT(distance, ball.radius - 4 * double(std::numeric_limits<TypeParam>::epsilon()))
          << "step " << step;
    });
    contacts += simulation.report(0).nodes_in_contact;
  }
  EXPECT_GT(contacts, 100);
}

TYPED_TEST(SimulationWithABall, ASplitOnABallLeavesNoNodeInside) {
  // Eq. 8's means lie on chords of the ball; the step after a split must push them out.
  SimulationDescription scene = busy_scene();
  scene.balls[0].velocity = {0, 0, 0};
  scene.balls[0].position = {0, 0, -0.2};
  Simulation<TypeParam> simulation(scene);
  for (int level : {4, 5, 6, 4, 5}) {
    simulation.request_level(0, level);
    run(simulation, 3);
    const Particles<TypeParam>& particles = simulation.cloths()[0].particles();
    each_node(particles.grid(), [&](int r, int c) {
      const double distance = (particles.position_at(r, c) - Vec3(0, 0, -0.2)).norm();
      ASSERT_GT(distance, 0.3 - 4 * double(std::numeric_limits<TypeParam>::epsilon())) << "level " << level;
    });
  }
}

TEST(SimulationBalls, ClothAndDynamicBallTogetherKeepTheirMomentum) {
  // No gravity, a free sheet at rest, a ball of 0.2 kg at 2 m/s: what the ball loses the cloth has. To
  // rounding with an explicit method; implicit ones solve loosely, and BDF2 steps nodes in contact by another
  // formula.
  SimulationDescription scene = busy_scene();
  scene.integrator = SymplecticEulerDescription{};
  scene.effects.clear();
  scene.cloths[0].pins.clear();
  scene.balls[0] = ball_at({0.1, -0.05, 0.35}, 0.3, {0, 0, -2});
  scene.balls[0].motion = BallDescription::Motion::dynamic;
  scene.balls[0].mass = 0.2;
  Simulation<double> simulation(scene);
  run(simulation, 30);
  const Vec3 cloth = linear_momentum(simulation.cloths()[0].particles());
  const Vec3 ball = 0.2 * simulation.colliders().balls()[0].velocity;
  EXPECT_LT(cloth.z(), -0.05);
  EXPECT_LT((cloth + ball - Vec3(0, 0, -0.4)).norm(), 1e-12);
}

TEST(SimulationBalls, ThreeSheetsThatShareABallKeepTheMomentumToo) {
  // One behind the other, 0.5 mm apart: within a few steps the ball touches all three.
  SimulationDescription scene = busy_scene();
  scene.integrator = SymplecticEulerDescription{};
  scene.effects.clear();
  scene.cloths[0].pins.clear();
  for (const double behind : {0.0005, 0.001}) {
    scene.cloths.push_back(scene.cloths[0]);
    scene.cloths.back().position.z() -= behind;
  }
  scene.balls[0] = ball_at({0.1, -0.05, 0.35}, 0.3, {0, 0, -2});
  scene.balls[0].motion = BallDescription::Motion::dynamic;
  scene.balls[0].mass = 0.2;
  Simulation<double> simulation(scene);
  int most = 0;
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    most = std::max(most, simulation.colliders().balls()[0].sharing);
  }
  EXPECT_GE(most, 2);
  Vec3 momentum = 0.2 * simulation.colliders().balls()[0].velocity;
  for (const Cloth<double>& cloth : simulation.cloths()) momentum += linear_momentum(cloth.particles());
  EXPECT_LT((momentum - Vec3(0, 0, -0.4)).norm(), 1e-12);
}

TEST(SimulationBalls, FarTilesAreNotExaminedInAWholeRun) {
  // Level 6, a ball of 5 cm resting in the middle of one of 64 tiles of a sheet held all round: at most that
  // tile in each substep, before it (which nodes will meet it), in it (which are inside) and after it; the
  // first step, which begins with letting nodes out of it, is not counted.
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.pins = {{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}};
  scene.cloths = {cloth};
  scene.balls = {ball_at({0.125, 0.125, 0.04}, 0.05)};
  Simulation<float> simulation(scene);
  run(simulation, 1);
  const ContactCounters first = simulation.cloths()[0].contact_counters();
  run(simulation, 3);
  const ContactCounters counters = simulation.cloths()[0].contact_counters();
  const auto substeps = std::uint64_t(simulation.report(0).substeps);
  EXPECT_GT(counters.nodes_in_contact, first.nodes_in_contact);
  EXPECT_LE(counters.tiles_examined - first.tiles_examined, 3 * 3 * substeps);
  EXPECT_GE(counters.tiles_examined - first.tiles_examined, substeps);
  EXPECT_LE(counters.nodes_tested - first.nodes_tested, 3 * 3 * substeps * 81);
}

TEST(SimulationBalls, LongStepsOntoARoughOneBringInNoEnergy) {
  // Falls 5 cm and drapes itself over 0.3 m of ball, in steps in which it gets on by up to a third of that.
  // Nothing does work on it: its energy stays under the start's, to 1 % of what falling 2 m would free.
  for (const IntegratorDescription& method :
       {IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    for (const int hz : {30, 15}) {
      SimulationDescription scene;
      ClothDescription cloth;
      cloth.initial_level = 5;
      cloth.position = {0, 0.35, 0};
      cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
      scene.cloths = {cloth};
      scene.balls = {ball_at({0, 0, 0}, 0.3)};
      scene.balls[0].friction = 0.5;
      scene.effects = {GravityEffect{}, DampingEffect{}};
      scene.integrator = method;
      scene.time_step = 1.0 / hz;
      Simulation<float> simulation(scene);
      const auto energy = [&] {
        return simulation.report(0).kinetic_energy + simulation.report(0).potential_energy;
      };
      const double most = energy() + 0.01 * simulation.cloths()[0].total_mass() * 9.81 * 2;
      for (int step = 0; step < hz; ++step) {
        simulation.step();
        ASSERT_LE(energy(), most) << hz << " Hz, step " << step;
      }
    }
  }
}

// A ball of friction 0.3 goes to and fro at 0.5 m/s under a sheet of 4 N held by its corners, in 1/15 s. The
// friction of its weight and of what holds it down stretches a corner's spring by 0.054 at every turn at 60
// Hz (S20a, of which this is the first half); by the last step's force alone it was 0.13 here at one of them.
TEST(SimulationBallsNightly, OneRollingUnderASheetRubsByItsUsualWeight) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {2, 2};
  cloth.initial_level = 6;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.material.damping = 0.5;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  scene.cloths = {cloth};
  scene.balls = {ball_at({0, 0, 0}, 0.25)};
  scene.balls[0].friction = 0.3;
  scene.balls[0].path = {{0, {-0.5, -0.5, 0}}};
  for (int turn = 0; turn <= 16; ++turn)
    scene.balls[0].path.push_back({1 + 2.0 * turn, {turn % 2 == 0 ? -0.5 : 0.5, -0.15, 0}});
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = Bdf2Description{};
  scene.time_step = 1.0 / 15;
  Simulation<float> simulation(scene);
  run(simulation, 15);
  double most = 0;
  for (int step = 15; step < 32 * 15; ++step) {
    simulation.step();
    most = std::max(most, simulation.report(0).strain.max);
  }
  EXPECT_LT(most, 0.08);
}

TEST(SimulationBalls, AFastOneIntoAClothInTheWindIsSurvived) {
  // The speed it gives the nodes within a step asks for far more drag than when the substeps were chosen. At
  // most the ball's energy, 1/2 * 1 kg * (200 m/s)^2 = 20 kJ, comes into a cloth that had a few joules.
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.initial_level = 5;
  cloth.material = find_fabric("silk")->material;
  cloth.pins = {{0, 0, 0, 1}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.wind = {{1, 0, 0}, 7.0};
  scene.balls = {ball_at({0, 0, 1.5}, 0.2, {0, 1, -200})};
  scene.balls[0].motion = BallDescription::Motion::dynamic;
  Simulation<float> simulation(scene);
  run(simulation, 30);
  EXPECT_TRUE(simulation.healthy());
  EXPECT_LT(simulation.report(0).kinetic_energy, 20e3);
}

TEST(SimulationBalls, AClothWithoutBallsHasNoContactWork) {
  SimulationDescription scene = busy_scene();
  scene.balls.clear();
  Simulation<float> simulation(scene);
  run(simulation, 3);
  EXPECT_EQ(simulation.cloths()[0].contact_counters().tiles_examined, 0u);
  EXPECT_EQ(simulation.report(0).nodes_in_contact, 0);
}

}  // namespace
}  // namespace weft
