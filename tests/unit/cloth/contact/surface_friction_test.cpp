// Friction of one contact: a spring along the surface that sticks up to Coulomb's bound.
#include "cloth/contact/constraints/surface_friction.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

constexpr double kStuckStiffness = 1000, kHeldInertia = 10;  // N/m
constexpr double kHolds = 0.5;                               // N

/// One that was there in the last step, in which it slipped so far.
SurfaceFriction after(double slipped) {
  SurfaceFriction first({0, 0, 0}, 0);
  first.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  first.end({slipped, 0, 0}, kHolds);
  SurfaceFriction friction({0, 0, 0}, 0);
  friction.go_on_from(first);
  friction.keep_force_of(first, {0, 0, 1});
  return friction;
}

}  // namespace

// k s at the slip s, as long as that is less than it holds; then no more than that.
TEST(SurfaceFriction, SticksAsASpringUpToWhatItHolds) {
  SurfaceFriction friction = after(0);
  friction.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  EXPECT_EQ(friction.rate(), kStuckStiffness);
  EXPECT_NEAR(friction.force({1e-4, 0, 0}).x(), -kStuckStiffness * 1e-4, 1e-12);
  friction.end({0.1, 0, 0}, kHolds);
  EXPECT_NEAR(friction.grip().x(), -kHolds, 1e-12);
}

// What holds a load in one step holds it in the next one from the start: there is nothing to creep for.
TEST(SurfaceFriction, KeepsItsForceFromStepToStep) {
  SurfaceFriction last = after(0);
  last.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  last.end({3e-4, 0, 0}, kHolds);
  SurfaceFriction friction({0, 0, 0}, 0);
  friction.go_on_from(last);
  friction.keep_force_of(last, {0, 0, 1});
  friction.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  EXPECT_NEAR(friction.force({0, 0, 0}).x(), -kStuckStiffness * 3e-4, 1e-12);
  // The surface has turned: what would now point out of it is no friction.
  SurfaceFriction turned({0, 0, 0}, 0);
  turned.go_on_from(last);
  turned.keep_force_of(last, {1, 0, 0});
  turned.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  EXPECT_NEAR(turned.force({0, 0, 0}).norm(), 0, 1e-12);
}

// A node alone, of inertia M, that a force F draws: M s = F - holds. Held by the full spring it slips by F /
// (M + k), from which the next system expects that slip.
TEST(SurfaceFriction, ExpectsOfWhatIsPulledTooHardTheSlipOfTheNodeAlone) {
  constexpr double kPull = 2;  // N
  SurfaceFriction friction = after(0);
  friction.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  const double stuck = kPull / (kHeldInertia + kStuckStiffness);
  EXPECT_GT(friction.error({stuck, 0, 0}, kHolds), 0);
  friction.linearise({stuck, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  const double slip = (kPull - kHolds) / kHeldInertia;
  EXPECT_NEAR(friction.force({slip, 0, 0}).x(), -kHolds, 0.01 * kHolds);
  EXPECT_LT(friction.error({slip, 0, 0}, kHolds), 0.01 * kHolds * slip);
}

// However far the expected slip was off, what slides is braked, never driven.
TEST(SurfaceFriction, NeverDrivesWhatSlides) {
  SurfaceFriction friction({0.01, 0, 0}, 0);
  friction.linearise({0, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  friction.linearise({0.01, 0, 0}, kHolds, kStuckStiffness, kHeldInertia);
  for (const double slip : {-0.05, -0.001, 0.001, 0.05}) {
    EXPECT_LE(friction.force({slip, 0, 0}).x() * slip, 0) << slip;
  }
}

// Coulomb's impact: of a slip of 10 mm a node that would go in by 8 mm loses mu 8 mm, one that would go in
// deeply all of it.
TEST(SurfaceFriction, StopsOfAnImpactsSlipItsCoefficientTimesTheDepth) {
  constexpr double kCoefficient = 0.5;
  SurfaceFriction some({0.01, 0, 0}, kCoefficient * 0.008);
  some.linearise({0, 0, 0}, 0, kStuckStiffness, kHeldInertia);
  const double slip = 0.01 - kCoefficient * 0.008;
  EXPECT_NEAR(some.force({slip, 0, 0}).x(), -kHeldInertia * kCoefficient * 0.008, 1e-12);
  SurfaceFriction all({0.01, 0, 0}, kCoefficient * 0.1);
  all.linearise({0, 0, 0}, 0, kStuckStiffness, kHeldInertia);
  EXPECT_EQ(all.rate(), kStuckStiffness);
}

}  // namespace weft::test
