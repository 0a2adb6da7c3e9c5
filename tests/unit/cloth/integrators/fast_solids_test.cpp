// How many parts an implicit step has beside a fast solid.
#include "cloth/integrators/fast_solids.h"

#include <gtest/gtest.h>

#include "loose_contact.h"

namespace weft {
namespace {

using test::kFrame;

constexpr double kRadius = 0.1;

/// Goes at `speed` along z, through the middle of a sheet that lies in z = 0.
Solid shot_ball(double speed) {
  Solid ball;
  ball.id = 1;
  ball.shape = Sphere{kRadius};
  ball.start = {0, 0, -0.2};
  ball.position = ball.start + Vec3(0, 0, kFrame * speed);
  ball.velocity = {0, 0, speed};
  return ball;
}

/// Of a step of one substep, for a sheet of 2 m whose nodes all go at `speed` along z.
int parts_beside(const Solid& solid, double speed, int substeps = 1) {
  Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
  for (double& z : sheet.velocity.z.values()) z = speed;
  test::LooseContact<double> contact(sheet.grid());
  return parts_beside_fast_solids(sheet, contact, {solid}, kFrame / substeps, kFrame);
}

TEST(FastSolids, HaveSoManyPartsThatNoneIsPassedByMoreThanItsRadius) {
  EXPECT_EQ(parts_beside(shot_ball(59), 0), 10);  // 0.98 m in the step
  EXPECT_EQ(parts_beside(shot_ball(59), 0, 4), 3);
  EXPECT_EQ(parts_beside(shot_ball(25), 0), 5);  // 0.42 m
  EXPECT_EQ(parts_beside(shot_ball(59), -30), 15);
}

TEST(FastSolids, HaveSixteenPartsAtMost) { EXPECT_EQ(parts_beside(shot_ball(200), 0), 16); }

TEST(FastSolids, HaveNoPartsWhereNothingIsMet) {
  Solid away = shot_ball(59);
  away.start.z() -= 2;
  away.position.z() -= 2;
  EXPECT_EQ(parts_beside(away, 0), 1);
  EXPECT_EQ(parts_beside(shot_ball(-59), 0), 1);
}

TEST(FastSolids, HaveNoPartsWhereTheyYieldOrHaveNoEnd) {
  Solid dynamic = shot_ball(59);
  dynamic.inverse_mass = 1;
  EXPECT_EQ(parts_beside(dynamic, 0), 1);
  Solid wall = shot_ball(59);
  wall.shape = HalfSpace{};
  EXPECT_EQ(parts_beside(wall, 0), 1);
}

TEST(FastSolids, GoOnInPartsWhileClothIsCarriedOutOfTheRest) {
  // A node at the ball's front goes with it; the mean of 289 nodes does not.
  Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
  const Solid ball = shot_ball(59);
  test::set(sheet.position, 8, 8, ball.start + Vec3(0, 0, 0.99 * kRadius));
  test::set(sheet.velocity, 8, 8, ball.velocity);
  test::LooseContact<double> contact(sheet.grid());
  std::vector<Solid> solids{ball};
  solids[0].position = solids[0].start;  // where it is as the last step ends
  contact.resolve(sheet, solids, {0, 1, kFrame});
  ASSERT_EQ(contact.touches().size(), 1U);
  // (1 - 1 / 289) of 0.983 m.
  EXPECT_EQ(parts_beside_fast_solids(sheet, contact, {ball}, kFrame, kFrame), 10);
  // All go with it.
  for (double& z : sheet.velocity.z.values()) z = 59;
  EXPECT_EQ(parts_beside_fast_solids(sheet, contact, {ball}, kFrame, kFrame), 1);
}

}  // namespace
}  // namespace weft
