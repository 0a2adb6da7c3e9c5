// When a cloth sleeps and wakes, of the steps that it is told of alone.
#include <gtest/gtest.h>

#include <limits>

#include "cloth/sleep/sleep.h"
#include "fixtures.h"

namespace weft {
namespace {

constexpr double kSleepSpeed = 1e-4;  // m/s

/// A sheet of 1 m about the origin, in still air, and what is told to its Sleep.
struct Sleeping {
  explicit Sleeping(double speed = kSleepSpeed) : sleep(speed) {}
  /// One that is left out if the cloth sleeps, or else leaves it at this speed.
  bool step(double speed = 0) {
    const bool left_out = sleep.through(particles, solids, air);
    if (!left_out) sleep.stepped(speed, test::kFrame, particles, solids);
    return left_out;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  void fall_asleep() {
    steps(Sleep::kQuietSteps);
    ASSERT_TRUE(sleep.asleep());
  }
  void move(const Vec3& by) {
    test::each_node(particles.grid(), [&](int r, int c) {
      test::set(particles.position, r, c, particles.local_position_at(r, c) + by);
    });
  }

  Particles<double> particles = test::flat_sheet<double>(5, 5, {1, 1});
  std::vector<Solid> solids;
  Air air;
  Sleep sleep;
};

Solid ball_near(const Vec3& place) {
  Solid ball;
  ball.id = 1;
  ball.shape = Sphere{0.1};
  ball.start = ball.position = place;
  return ball;
}

TEST(ClothSleep, BeginsWhenAllNodesHaveStayedForTheQuietSteps) {
  Sleeping cloth;
  cloth.steps(Sleep::kQuietSteps - 1);
  EXPECT_FALSE(cloth.sleep.asleep());
  EXPECT_FALSE(cloth.sleep.quiet());
  EXPECT_FALSE(cloth.step());
  EXPECT_TRUE(cloth.sleep.asleep());
  EXPECT_TRUE(cloth.sleep.quiet());
  EXPECT_TRUE(cloth.step());
}

// As far as the threshold takes a node in the quiet steps: nearer they stay, farther they begin anew.
TEST(ClothSleep, WhatCountsIsHowFarNodesGet) {
  const double most = kSleepSpeed * Sleep::kQuietSteps * test::kFrame;
  for (const double share : {0.99, 1.01}) {
    Sleeping cloth;
    cloth.steps(Sleep::kQuietSteps - 1);
    test::set(cloth.particles.position, 2, 3,
              cloth.particles.local_position_at(2, 3) + Vec3(0, 0, share * most));
    cloth.step(0.3);  // shaken, but not on its way
    EXPECT_EQ(cloth.sleep.asleep(), share < 1) << share;
  }
}

// Faster than a metre a second it cannot rest: what was watched is forgotten.
TEST(ClothSleep, APlainlyMovingClothIsNotWatched) {
  Sleeping cloth;
  cloth.steps(Sleep::kQuietSteps - 1);
  cloth.step(1.01);
  cloth.step();
  EXPECT_FALSE(cloth.sleep.asleep());
  cloth.steps(Sleep::kQuietSteps - 1);
  EXPECT_TRUE(cloth.sleep.asleep());
}

TEST(ClothSleep, WithoutAThresholdItNeverSleeps) {
  Sleeping cloth(0);
  cloth.steps(3 * Sleep::kQuietSteps);
  EXPECT_FALSE(cloth.sleep.asleep());
}

TEST(ClothSleep, NoNumberIsNoRest) {
  Sleeping cloth;
  cloth.particles.position.x.at(2, 2) = std::numeric_limits<double>::quiet_NaN();
  cloth.steps(3 * Sleep::kQuietSteps);
  EXPECT_FALSE(cloth.sleep.asleep());
}

TEST(ClothSleep, AfterItIsWokenItTakesItsTimeAgain) {
  Sleeping cloth;
  cloth.fall_asleep();
  cloth.sleep.wake();
  EXPECT_FALSE(cloth.sleep.asleep());
  cloth.steps(Sleep::kQuietSteps - 1);
  EXPECT_FALSE(cloth.sleep.asleep());
  cloth.step();
  EXPECT_TRUE(cloth.sleep.asleep());
}

// In the margin of 1 % about the box: what moves, yields, came or went wakes it. What is far does not.
TEST(ClothSleep, SolidsNearItWakeIt) {
  const Vec3 near(0, 0, 0.105), far(0, 0, 0.12);
  {
    Sleeping cloth;
    cloth.fall_asleep();
    cloth.solids = {ball_near(near)};
    EXPECT_FALSE(cloth.step()) << "came";
  }
  {
    Sleeping cloth;
    cloth.solids = {ball_near(near)};
    cloth.fall_asleep();
    EXPECT_TRUE(cloth.step());
    cloth.solids.clear();
    EXPECT_FALSE(cloth.step()) << "went";
  }
  {
    Sleeping cloth;
    cloth.solids = {ball_near(near)};
    cloth.fall_asleep();
    cloth.solids[0].velocity = {0, 0, 1};
    EXPECT_FALSE(cloth.step()) << "moves";
  }
  {
    Sleeping cloth;
    cloth.fall_asleep();
    cloth.solids = {ball_near({0, 0, 1})};
    cloth.solids[0].position = near;
    EXPECT_FALSE(cloth.step()) << "ends near";
  }
  {
    Sleeping cloth;
    cloth.fall_asleep();
    cloth.solids = {ball_near({0, 0, 1})};
    cloth.solids[0].start = near;
    EXPECT_FALSE(cloth.step()) << "begins near";
  }
  {
    Sleeping cloth;
    cloth.solids = {ball_near(near)};
    cloth.fall_asleep();
    cloth.solids[0].inverse_mass = 1;
    EXPECT_FALSE(cloth.step()) << "yields";
  }
  {
    Sleeping cloth;
    cloth.fall_asleep();
    cloth.solids = {ball_near(far)};
    cloth.solids[0].velocity = {0, 0, 1};
    cloth.solids[0].inverse_mass = 1;
    EXPECT_TRUE(cloth.step()) << "far";
  }
}

// While something moves near it, it does not fall asleep.
TEST(ClothSleep, BesideAMovingSolidItStaysAwake) {
  Sleeping cloth;
  cloth.solids = {ball_near({0, 0, 0.105})};
  cloth.solids[0].spin = {0, 1, 0};
  cloth.solids[0].turn = {0, 0.1, 0};
  cloth.steps(2 * Sleep::kQuietSteps);
  EXPECT_FALSE(cloth.sleep.asleep());
  cloth.solids[0].spin = cloth.solids[0].turn = {0, 0, 0};
  cloth.step();
  EXPECT_TRUE(cloth.sleep.asleep());
}

// It sleeps in steady wind, wakes when that changes, and never sleeps in gusts or turbulence.
TEST(ClothSleep, WakesWhenTheWindChanges) {
  Sleeping cloth;
  cloth.air = Air({{0, 0, -1}, 2}, 1);
  cloth.steps(Sleep::kQuietSteps + 1);
  EXPECT_TRUE(cloth.sleep.asleep());
  cloth.air.change({{0, 0, -1}, 3}, 1);
  EXPECT_FALSE(cloth.step());
  cloth.steps(Sleep::kQuietSteps);
  EXPECT_TRUE(cloth.step());
  for (const Wind& wind : {Wind{{0, 0, -1}, 3, {0.2}}, Wind{{0, 0, -1}, 3, {}, {0.2}}}) {
    cloth.air.change(wind, 2);
    cloth.steps(2 * Sleep::kQuietSteps);
    EXPECT_FALSE(cloth.sleep.asleep());
  }
}

// With restless company it is quiet but awake; with quiet company it falls asleep with it.
TEST(ClothSleep, FallsAsleepWithItsCompany) {
  Sleeping cloth;
  cloth.sleep.set_company(Sleep::Company::restless);
  cloth.steps(2 * Sleep::kQuietSteps);
  EXPECT_TRUE(cloth.sleep.quiet());
  EXPECT_FALSE(cloth.sleep.asleep());
  cloth.sleep.set_company(Sleep::Company::quiet);
  EXPECT_TRUE(cloth.step());
  EXPECT_TRUE(cloth.sleep.asleep());
}

// For islands: around all nodes with 1 % of the largest extent, quiet or not.
TEST(ClothSleep, ForIslandsItIsABoxAndWhetherItIsQuiet) {
  Sleeping cloth;
  cloth.particles.place = {5, 0, 0};
  const Sleeper awake = cloth.sleep.sleeper(cloth.particles);
  EXPECT_FALSE(awake.quiet);
  EXPECT_LT((awake.box.min() - Vec3(4.49, -0.51, -0.01)).norm(), 1e-12);
  EXPECT_LT((awake.box.max() - Vec3(5.51, 0.51, 0.01)).norm(), 1e-12);
  cloth.fall_asleep();
  EXPECT_TRUE(cloth.sleep.sleeper(cloth.particles).quiet);
}

// Told to rest it sleeps though it moves and in any wind; once woken one step is made, and no more.
TEST(ClothSleep, ToldToRestItsStepsAreLeftOut) {
  Sleeping cloth;
  cloth.air = Air({{0, 0, -1}, 3, {0.2}}, 1);
  cloth.step(5);
  cloth.sleep.set_resting(true);
  EXPECT_TRUE(cloth.step(5));
  EXPECT_TRUE(cloth.sleep.left_out());
  EXPECT_TRUE(cloth.sleep.asleep());
  cloth.sleep.wake();
  EXPECT_FALSE(cloth.step(5));
  EXPECT_TRUE(cloth.step(5));
  // But for the steps in which a solid near it moves.
  cloth.solids = {ball_near({0, 0, 0.105})};
  EXPECT_TRUE(cloth.step(5));
  cloth.solids[0].velocity = {0, 0, -1};
  EXPECT_FALSE(cloth.step(5));
  cloth.solids[0].velocity = {0, 0, 0};
  EXPECT_TRUE(cloth.step(5));
  cloth.sleep.set_resting(false);
  EXPECT_FALSE(cloth.step(5));
  EXPECT_FALSE(cloth.sleep.left_out());
}

}  // namespace
}  // namespace weft
