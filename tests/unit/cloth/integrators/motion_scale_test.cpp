#include "cloth/integrators/motion_scale.h"

#include <gtest/gtest.h>

#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::set;

constexpr double kScaledStep = 1.0 / 60;

/// A sheet of 2 m and 0.4 kg, all of whose nodes move alike; held by its upper corners or free.
struct Measured {
  explicit Measured(bool hung, const Vec3& velocity)
      : rig(hung ? test::hung_rig<double>(5, 5, BackwardEulerDescription{})
                 : test::sheet_rig<double>(5, 5, BackwardEulerDescription{})),
        scale(rig.springs(), rig.particles.mass, kScaledStep) {
    each_node(rig.particles.grid(), [&](int r, int c) { set(rig.particles.velocity, r, c, velocity); });
    scale.measure(rig.particles);
  }
  test::Rig<double> rig;
  MotionScale<double> scale;
};

constexpr double kSheetMass = 0.4, kSheetSize = 2;
/// Twice the energy of the speed that gravity gives in the step, J.
constexpr double kGiven = kSheetMass * 9.81 * kScaledStep * 9.81 * kScaledStep;

// m v^2 and m (g h)^2; of what nothing holds without that of the mean velocity.
TEST(MotionScale, EnergyIsThatOfTheMotionAndOfWhatGravityGives) {
  const Measured held(true, {3, 0, 4}), flies(false, {3, 0, 4});
  EXPECT_NEAR(held.scale.energy(), kSheetMass * 25 + kGiven, 1e-12);
  EXPECT_NEAR(flies.scale.energy(), kGiven, 1e-12);
}

// Beside its mean velocity a free sheet's motion counts: half of the nodes' masses each way.
TEST(MotionScale, InFlightTheInnerMotionCounts) {
  Measured flies(false, {0, 0, 0});
  double kinetic = 0, mass = 0;
  Vec3 momentum(0, 0, 0);
  each_node(flies.rig.particles.grid(), [&](int r, int c) {
    const Vec3 velocity(7, r % 2 == 0 ? 2 : -2, 0);
    set(flies.rig.particles.velocity, r, c, velocity);
    const double m = flies.rig.particles.mass.at(r, c);
    kinetic += m * velocity.squaredNorm();
    momentum += m * velocity;
    mass += m;
  });
  flies.scale.measure(flies.rig.particles);
  EXPECT_NEAR(flies.scale.energy(), kinetic - momentum.squaredNorm() / mass + kGiven, 1e-12);
}

// 5 / 1000 of its size a second.
TEST(MotionScale, NearRestIsToldByTheSizeOfTheCloth) {
  const double limit = 5e-3 * kSheetSize;
  EXPECT_TRUE(Measured(true, {0, 0.99 * limit, 0}).scale.near_rest());
  EXPECT_FALSE(Measured(true, {0, 1.01 * limit, 0}).scale.near_rest());
}

// Near rest a sheet is held or falls: a solve that finds more than a tenth of what gravity gives tells that.
TEST(MotionScale, WhatFallsIsNotFine) {
  Measured sheet(true, {0, 0, 0});
  EXPECT_TRUE(sheet.scale.fine());
  sheet.scale.found(0.05 * kGiven);
  EXPECT_TRUE(sheet.scale.fine());
  EXPECT_LT(sheet.scale.energy(), 1e-2 * kGiven);
  sheet.scale.found(0.5 * kGiven);
  EXPECT_FALSE(sheet.scale.fine());
  EXPECT_NEAR(sheet.scale.energy(), kGiven, 1e-12);
  sheet.scale.measure(sheet.rig.particles);  // in the next substep it is to be told again
  EXPECT_TRUE(sheet.scale.fine());
  EXPECT_FALSE(Measured(true, {0, 1, 0}).scale.fine());
}

// Twice as fast, a solve may be off by twice as much: by the squares of tolerance and speed.
TEST(MotionScale, ATargetIsAShareOfTheMotion) {
  const SolveTarget slow = Measured(true, {0, 1, 0}).scale.target(0.1, false),
                    fast = Measured(true, {0, 2, 0}).scale.target(0.1, false);
  EXPECT_NEAR(slow.share, 0.01, 1e-15);
  EXPECT_NEAR(fast.least / slow.least, 4, 1e-4);
  EXPECT_NEAR(slow.least, 0.01 * kSheetMass, 1e-6);
  EXPECT_GE(slow.most, slow.least);
}

// A sheet that nothing pins is solved alike however fast it is carried along (Galilei), unless it is near
// rest.
TEST(MotionScale, ATargetDoesNotKnowHowFastTheSheetIsCarried) {
  const SolveTarget slow = Measured(false, {1, 0, 0}).scale.target(0.1, true),
                    fast = Measured(false, {30, 0, 40}).scale.target(0.1, true);
  // Beside what gravity gives rounding of a speed of 50 m/s is nothing.
  EXPECT_NEAR(fast.most, slow.most, 1e-9 * kGiven);
  EXPECT_NEAR(fast.least, slow.least, 1e-9 * kGiven);
}

// On its way to rest it is solved ever more finely, and in contact near rest not by a share of what it finds.
TEST(MotionScale, NearRestTargetsAreFinerAndInContactNoShare) {
  const MotionScale<double> moving = Measured(true, {0, 1, 0}).scale,
                            resting = Measured(true, {0, 1e-3, 0}).scale;
  EXPECT_LT(resting.target(0.1, false).least, 1e-5 * moving.target(0.1, false).least);
  EXPECT_LT(resting.target(0.1, false).most, 1e-2 * moving.target(0.1, false).most);
  EXPECT_EQ(resting.target(0.1, true).share, 0);
  EXPECT_GT(moving.target(0.1, true).share, 0);
}

}  // namespace
}  // namespace weft
