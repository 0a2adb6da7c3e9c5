// How many parts an implicit step has beside a fast solid.
#include "cloth/integrators/fast_solids.h"

#include <gtest/gtest.h>

#include "fixtures.h"
#include "loose_contact.h"

namespace weft {
namespace {

using test::kFrame;

constexpr double kShotRadius = 0.1, kShotCell = 0.125;  // m

/// Goes at `speed` along z, through the middle of a sheet that lies in z = 0.
Solid shot_ball(double speed) {
  Solid ball;
  ball.id = 1;
  ball.shape = Sphere{kShotRadius};
  ball.start = {0, 0, -0.2};
  ball.position = ball.start + Vec3(0, 0, kFrame * speed);
  ball.velocity = {0, 0, speed};
  return ball;
}

/// Of a step of one substep, for a sheet of 2 m whose nodes all go at `speed` along z.
int parts_beside(const Solid& solid, double speed, int substeps = 1, double cell = kShotCell) {
  Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
  for (double& z : sheet.velocity.z.values()) z = speed;
  test::LooseContact<double> contact(sheet.grid());
  return parts_beside_fast_solids(sheet, sheet.velocity, contact, {solid}, cell, kFrame / substeps, kFrame);
}

// The longest way is a quarter of 0.1 m, or of a cell of 0.04 m; of so many parts the next power of two is
// taken.
TEST(FastSolids, HaveSoManyPartsThatNoneIsPassedByMoreThanAQuarterOfItOrOfACell) {
  EXPECT_EQ(parts_beside(shot_ball(15), 0, 12), 1);       // 0.021 m of 0.025
  EXPECT_EQ(parts_beside(shot_ball(15), 0, 8), 2);        // 0.031 m
  EXPECT_EQ(parts_beside(shot_ball(15), 0, 4), 4);        // 0.0625 m, 2.5 times as much
  EXPECT_EQ(parts_beside(shot_ball(15), -15, 4), 8);      // beside the sheet's own way twice that
  EXPECT_EQ(parts_beside(shot_ball(15), 0, 4, 0.04), 8);  // 6.25 times 0.01 m
  EXPECT_EQ(parts_beside(shot_ball(15), 0, 2), 8);        // 0.125 m
}

TEST(FastSolids, HaveSixteenPartsAtMost) { EXPECT_EQ(parts_beside(shot_ball(200), 0), 16); }

TEST(FastSolids, HaveNoPartsWhereNothingIsMet) {
  Solid away = shot_ball(59);
  away.start.z() -= 2;
  away.position.z() -= 2;
  EXPECT_EQ(parts_beside(away, 0), 1);
  EXPECT_EQ(parts_beside(shot_ball(-59), 0), 1);
}

TEST(FastSolids, HaveNoPartsWhereTheyHaveNoEnd) {
  Solid wall = shot_ball(59);
  wall.shape = HalfSpace{};
  EXPECT_EQ(parts_beside(wall, 0), 1);
}

TEST(FastSolids, ThatYieldHaveSoManyPartsThatNoneIsPassedByMoreThanItsRadius) {
  Solid dynamic = shot_ball(15);
  dynamic.inverse_mass = 1;
  EXPECT_EQ(parts_beside(dynamic, 0, 3), 1);  // 0.083 m of 0.1
  EXPECT_EQ(parts_beside(dynamic, 0, 2), 2);  // 0.125 m
  EXPECT_EQ(parts_beside(dynamic, 0), 4);     // 0.25 m
}

// A part n times as short gains an n^2-th of the way in it: so many that it is no more than a quarter of 0.1
// m.
TEST(FastSolids, HavePartsForWhatTheAirGivesInTheStep) {
  const auto parts = [](double gained) {
    Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
    VectorField<double> in_air(sheet.grid());
    for (double& z : in_air.z.values()) z = -gained / kFrame;
    test::LooseContact<double> contact(sheet.grid());
    Solid ball = shot_ball(0);
    ball.start.z() = ball.position.z() = -kShotRadius - 0.001;
    return parts_beside_fast_solids(sheet, in_air, contact, {ball}, kShotCell, kFrame, kFrame);
  };
  EXPECT_EQ(parts(0.024), 1);
  EXPECT_EQ(parts(0.026), 2);
  EXPECT_EQ(parts(0.09), 2);  // 1.9^2 times 0.025 m
  EXPECT_EQ(parts(0.11), 4);  // 2.1^2 times, and longer than the radius
}

TEST(FastSolids, GoOnInPartsWhileClothIsCarriedOutOfTheRest) {
  // A node at the ball's front goes with it; the mean of 289 nodes does not.
  Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
  const Solid ball = shot_ball(59);
  test::set(sheet.position, 8, 8, ball.start + Vec3(0, 0, 0.99 * kShotRadius));
  test::set(sheet.velocity, 8, 8, ball.velocity);
  test::LooseContact<double> contact(sheet.grid());
  std::vector<Solid> solids{ball};
  solids[0].position = solids[0].start;  // where it is as the last step ends
  contact.resolve(sheet, solids, {0, 1, kFrame});
  ASSERT_EQ(contact.touches().size(), 1U);
  // (1 - 1 / 289) of 0.123 m, 4.9 times 0.025 m.
  EXPECT_EQ(parts_beside_fast_solids(sheet, sheet.velocity, contact, {ball}, kShotCell, kFrame / 8, kFrame),
            8);
  // All go with it.
  for (double& z : sheet.velocity.z.values()) z = 59;
  EXPECT_EQ(parts_beside_fast_solids(sheet, sheet.velocity, contact, {ball}, kShotCell, kFrame / 8, kFrame),
            1);
}

}  // namespace
}  // namespace weft
