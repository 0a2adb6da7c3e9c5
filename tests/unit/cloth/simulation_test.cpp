// A scene in motion: the step, its clock, commands, reset, determinism, contact with balls, non-finite
// states.
#include "cloth/simulation.h"

#include <gtest/gtest.h>

#include <limits>

#include "cloth/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

BallDescription ball_at(const Vec3& position, double radius, const Vec3& velocity = {0, 0, 0}) {
  BallDescription ball;
  ball.position = position;
  ball.radius = radius;
  ball.velocity = velocity;
  return ball;
}

/// A cloth hung by two corners in the wind, level 4, with a ball on its way through it.
SimulationDescription busy_scene() {
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
  changed.set_integrator(XpbdDescription{7});
  EXPECT_TRUE(test::same_state(before, changed.cloths()[0].particles()));
  changed.step();
  EXPECT_EQ(changed.report(0).substeps, 7);
  EXPECT_EQ(changed.step_count(), 6u);
  // There and back between two steps is as if nothing had been said: these methods remember nothing.
  run(other, 5);
  other.set_integrator(XpbdDescription{7});
  other.step();
  other.set_integrator(BackwardEulerDescription{});
  other.set_integrator(XpbdDescription{7});
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

// --- Balls ---

TYPED_TEST(SimulationOf, NoFreeNodeIsInsideABallAfterAnyStep) {
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

TYPED_TEST(SimulationOf, ASplitOnABallLeavesNoNodeInside) {
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
  // An impulse is taken up at the end of its step and moves the ball in the next: one idle step with the
  // velocity read.
  const Vec3 cloth = linear_momentum(simulation.cloths()[0].particles());
  Colliders colliders = simulation.colliders();
  colliders.begin_step(0, scene.time_step, {0, 0, 0});
  const Vec3 ball = 0.2 * colliders.balls()[0].velocity;
  EXPECT_LT(cloth.z(), -0.05);
  EXPECT_LT((cloth + ball - Vec3(0, 0, -0.4)).norm(), 1e-12);
}

TEST(SimulationBalls, FarTilesAreNotExaminedInAWholeRun) {
  // Level 6, a ball of 5 cm resting in the middle of one of 64 tiles of a sheet held all round: at most that
  // tile in each substep.
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.pins = {{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}};
  scene.cloths = {cloth};
  scene.balls = {ball_at({0.125, 0.125, 0.04}, 0.05)};
  Simulation<float> simulation(scene);
  run(simulation, 3);
  const ContactCounters counters = simulation.cloths()[0].contact_counters();
  const auto substeps = std::uint64_t(simulation.report(0).substeps);
  EXPECT_GT(counters.nodes_in_contact, 0u);
  EXPECT_LE(counters.tiles_examined, 3 * substeps);
  EXPECT_GE(counters.tiles_examined, substeps);
  EXPECT_LE(counters.nodes_tested, 3 * substeps * 81);
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

// --- Several cloths, level changes, bad states ---

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

TYPED_TEST(SimulationOf, StaysSoundThroughLevelChanges) {
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

TYPED_TEST(SimulationOf, ANonFiniteStateIsSeen) {
  using Limits = std::numeric_limits<TypeParam>;
  for (TypeParam bad : {Limits::quiet_NaN(), Limits::infinity()}) {
    Simulation<TypeParam> simulation(busy_scene());
    simulation.step();
    ASSERT_TRUE(simulation.healthy());
    simulation.cloths()[0].particles().position.y.at(7, 9) = bad;
    simulation.step();
    EXPECT_FALSE(simulation.healthy());
    simulation.reset();
    EXPECT_TRUE(simulation.healthy());
    simulation.step();
    EXPECT_TRUE(simulation.healthy());
  }
}

TEST(SimulationHealth, FixedSubstepsBeyondTheLimitAreFoundOut) {
  SimulationDescription scene = busy_scene();
  scene.integrator = SymplecticEulerDescription{2, 0.9};
  scene.cloths[0].initial_level = 6;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 600 && simulation.healthy(); ++step) simulation.step();
  EXPECT_FALSE(simulation.healthy());
}

}  // namespace
}  // namespace weft
