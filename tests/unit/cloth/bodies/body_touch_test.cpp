#include "cloth/bodies/body_touch.h"

#include <gtest/gtest.h>

#include <numbers>

namespace weft::test {
namespace {

/// A cube of 0.2 m that yields, on its way from one place to another.
Solid cube_from(const Vec3& start, const Vec3& end) {
  Solid cube;
  cube.shape = Box{{0.1, 0.1, 0.1}};
  cube.start = start;
  cube.position = end;
  cube.inverse_mass = 1;
  cube.inverse_inertia = Eigen::Matrix3d::Identity();
  return cube;
}

BodyContact on_top(double gap) {
  return {.a = 0, .b = 1, .arm_a = {0, -0.1, 0}, .arm_b = {0, 0.1, 0}, .normal = {0, 1, 0}, .gap = gap};
}

}  // namespace

// The upper falls by 8 mm onto the lower, which gives by 1 mm.
TEST(BodyTouch, TellsByHowMuchTheyOverlap) {
  const std::vector<Solid> solids{cube_from({0, 0.205, 0}, {0, 0.197, 0}),
                                  cube_from({0, 0, 0}, {0, -0.001, 0})};
  const BodyTouch touch(on_top(0.005), solids);
  EXPECT_NEAR(touch.overlap(solids, 0), -0.005, 1e-15);
  EXPECT_NEAR(touch.overlap(solids, 0.5), -0.0015, 1e-15);
  EXPECT_NEAR(touch.overlap(solids, 1), 0.002, 1e-15);
}

// What a step begins with is no overlap: to undo it would speed them up.
TEST(BodyTouch, TakesTheOverlapAtTheStartForNone) {
  const std::vector<Solid> solids{cube_from({0, 0.19, 0}, {0, 0.188, 0}), cube_from({0, 0, 0}, {0, 0, 0})};
  const BodyTouch touch(on_top(-0.01), solids);
  EXPECT_NEAR(touch.overlap(solids, 0), 0, 1e-15);
  EXPECT_NEAR(touch.overlap(solids, 1), 0.002, 1e-15);
}

// The place on a solid turns with it: by half a turn about z the arm is the other way round at the end, and
// across it in the middle of the step, where it is told.
TEST(BodyTouch, GoesWithASolidThatTurns) {
  Solid turning = cube_from({0, 0.205, 0}, {0, 0.205, 0});
  turning.turn = {0, 0, std::numbers::pi};
  const std::vector<Solid> solids{turning, cube_from({0, 0, 0}, {0, 0, 0})};
  const BodyTouch touch(on_top(0.005), solids);
  EXPECT_LT((touch.arm_a(solids, 0.5) - Vec3(0, -0.1, 0)).norm(), 1e-15);
  EXPECT_LT((touch.arm_a(solids, 1) - Vec3(0.1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((touch.arm_b(solids, 1) - Vec3(0, 0.1, 0)).norm(), 1e-15);
}

// A ball's turning is not solved for.
TEST(BodyTouch, PushesABallAtItsCentre) {
  Solid ball = cube_from({0, 0.2, 0}, {0, 0.2, 0});
  ball.shape = Sphere{0.1};
  ball.inverse_inertia.setZero();
  const std::vector<Solid> solids{ball, cube_from({0, 0, 0}, {0, 0, 0})};
  EXPECT_EQ(BodyTouch(on_top(0), solids).arm_a(solids, 1), Vec3(0, 0, 0));
}

}  // namespace weft::test
