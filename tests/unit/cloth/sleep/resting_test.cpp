// A cloth that is told to rest is left as it is, moving or not, unless something moves it, and goes on later.
#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/world/state_hash.h"
#include "faults.h"
#include "folding_scenes.h"

namespace weft {
namespace {

using test::ball_at;
using test::hung_scene;
using test::run;

int substeps(const Simulation<float>& simulation, std::size_t cloth = 0) {
  return simulation.last_advance(cloth).substeps;
}

// Where nothing depends on the time the state is the same, to the bit, as if there had been no rest.
TEST(Resting, ItGoesOnFromWhereItWas) {
  for (const IntegratorDescription& integrator : test::default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    SimulationDescription scene = hung_scene();
    scene.cloths[0].pins = {{0, 0, 0, 0}};
    scene.integrator = integrator;
    Simulation<float> rested(scene), other(scene);
    run(rested, 20);
    const Particles<float> falling = rested.cloths()[0].particles();
    EXPECT_LT(falling.velocity.y.at(0, 16), -1.0F);  // m/s: its free corner
    rested.set_resting(0, true);
    for (int step = 0; step < 30; ++step) {
      rested.step();
      ASSERT_EQ(substeps(rested), 0);
      ASSERT_TRUE(rested.cloths()[0].asleep());
      ASSERT_TRUE(test::same_state(rested.cloths()[0].particles(), falling));
    }
    EXPECT_EQ(rested.step_count(), 50U);
    rested.set_resting(0, false);
    run(rested, 20);
    run(other, 40);
    EXPECT_TRUE(test::same_state(rested.cloths()[0].particles(), other.cloths()[0].particles()));
  }
}

TEST(Resting, NoWindMovesIt) {
  SimulationDescription scene = hung_scene();
  scene.effects.push_back(AerodynamicsEffect{});
  scene.wind = {{0, 0, -1}, 3.0};
  scene.wind.gusts.intensity = 0.3;
  for (const double sleep_speed : {1e-4, 0.0}) {
    scene.sleep_speed = sleep_speed;
    Simulation<float> simulation(scene);
    run(simulation, 5);
    simulation.set_resting(0, true);
    for (int step = 0; step < 20; ++step) {
      simulation.step();
      EXPECT_EQ(substeps(simulation), 0);
    }
    simulation.set_wind({{1, 0, 0}, 5.0});
    simulation.step();
    EXPECT_EQ(substeps(simulation), 0);
    simulation.set_resting(0, false);
    EXPECT_FALSE(simulation.cloths()[0].asleep());
    simulation.step();
    EXPECT_GT(substeps(simulation), 0);
  }
}

TEST(Resting, OneThatIsAtRestKeepsItsSleep) {
  SimulationDescription scene = hung_scene();
  scene.effects = {};
  scene.cloths[0].perturbation = 0;
  Simulation<float> simulation(scene);
  run(simulation, Sleep::kQuietSteps);
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  simulation.set_resting(0, true);
  run(simulation, 5);
  simulation.set_resting(0, false);
  simulation.step();
  EXPECT_TRUE(simulation.cloths()[0].asleep());
}

// A sheet of 2 m in the x-y plane, whose box has a margin of 1 % of that, and a ball of 0.2 m that comes with
// 0.2 m a step: it is near in the steps that bring it within 0.22 m of the plane or begin there.
TEST(Resting, ASolidMovesItWhileItIsNear) {
  SimulationDescription scene = hung_scene();
  scene.effects = {};
  scene.cloths[0].perturbation = 0;
  scene.balls = {ball_at({0, 0, 1.1}, 0.2, {0, 0, -12})};
  Simulation<float> simulation(scene);
  simulation.set_resting(0, true);
  simulation.step();  // makes the cloth's first step
  for (const double end : {0.7, 0.5}) {
    simulation.step();
    EXPECT_EQ(substeps(simulation), 0) << "the ball comes to " << end;
  }
  for (const double end : {0.3, 0.1, -0.1}) {
    simulation.step();
    EXPECT_EQ(substeps(simulation) > 0, end < 0.2) << "the ball comes to " << end;
  }
  EXPECT_GT(simulation.report(0).nodes_in_contact, 0);
  run(simulation, 300);  // 60 m away
  EXPECT_EQ(substeps(simulation), 0);
  EXPECT_GT(simulation.report(0).kinetic_energy, 0.1) << "left out, though it swings";
}

TEST(Resting, PinsAndHandsMoveIt) {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].pins[0].path = {{0.5, {0, 0, 0}}, {1, {0, 0.3, 0}}};
  Simulation<float> simulation(scene);
  simulation.set_resting(0, true);
  for (int step = 0; step < 60; ++step) {
    simulation.step();
    EXPECT_GT(substeps(simulation), 0) << "the pin has its way to go until 1 s; step " << step;
  }
  EXPECT_NEAR(simulation.cloths()[0].particles().position_at(0, 0).y(), 1.3, 1e-6);
  simulation.step();
  EXPECT_EQ(substeps(simulation), 0);
  const GrabId grab = simulation.grab(0, {0.5, 1}, std::nullopt, 10);
  for (int step = 0; step < 5; ++step) {
    simulation.step();
    EXPECT_GT(substeps(simulation), 0) << "held";
  }
  simulation.release(grab);
  simulation.step();  // the hand is gone, which it feels
  EXPECT_GT(substeps(simulation), 0);
  simulation.step();
  EXPECT_EQ(substeps(simulation), 0);
}

TEST(Resting, AnotherLevelIsEnteredAndAResetEndsIt) {
  Simulation<float> simulation(hung_scene());
  simulation.set_resting(0, true);
  run(simulation, 3);
  simulation.request_level(0, 5);
  simulation.step();
  EXPECT_EQ(simulation.cloths()[0].level(), 5);
  simulation.reset();
  EXPECT_FALSE(simulation.cloths()[0].resting());
  run(simulation, 2);
  EXPECT_GT(substeps(simulation), 0);
}

TEST(Resting, OthersGoOnAsIfItWereNotThere) {
  SimulationDescription scene = hung_scene();
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].name = "other";
  scene.cloths[1].position = {5, 0, 0};
  Simulation<float> both(scene), one(scene);
  one.set_resting(0, true);
  run(both, 60);
  run(one, 60);
  EXPECT_TRUE(test::same_state(one.cloths()[1].particles(), both.cloths()[1].particles()));
  EXPECT_FALSE(test::same_state(one.cloths()[0].particles(), both.cloths()[0].particles()));
}

// --- Beside other layers ---

TEST(RestingSlow, AClothThatFallsOntoItMovesIt) {
  // From 0.3 m above, which takes 0.25 s.
  Simulation<float> simulation(test::caught(4, Bdf2Description{}));
  simulation.set_resting(0, true);
  run(simulation, 1);
  int first = 0;
  for (int step = 2; step <= 40; ++step) {
    simulation.step();
    if (first == 0 && substeps(simulation) > 0) first = step;
  }
  EXPECT_GE(first, 13);
  EXPECT_LE(first, 17);
  run(simulation, 60);
  EXPECT_GT(simulation.centre(1).y(), -1) << "it was caught";
}

// Two sheets fly in a row, 6 mm apart, while a third one is far away: nothing acts on them. How fast they are
// after a rest is not how fast they became in a step, or each would think the other upon it.
TEST(Resting, LayersAreNotLedApartByARest) {
  SimulationDescription scene = test::cloth_scene({1, 1}, 3, Bdf2Description{});
  scene.effects = {ClothContactEffect{}};
  scene.cloths[0].velocity = {0, 0, 3};
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].position = {0, 0, 0.006};
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[2].position = {50, 0, 0};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 30; ++step) {
    for (const std::size_t cloth : {0U, 1U}) simulation.set_resting(cloth, step >= 5 && step < 10);
    simulation.step();
  }
  // 25 of 30 steps of 1/60 s at 3 m/s.
  EXPECT_NEAR(simulation.centre(0).z(), 1.25, 1e-4);
  EXPECT_NEAR(simulation.centre(1).z(), 1.256, 1e-4);
  EXPECT_NEAR(simulation.centre(2).z(), 1.5, 1e-4);
}

}  // namespace
}  // namespace weft
