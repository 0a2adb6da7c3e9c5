#include "cloth/core/vec3.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

TEST(TurnFromY, TakesYToTheDirectionByTheLeastTurn) {
  for (const Vec3& direction :
       {Vec3(0, 2, 0), Vec3(3, 0, 0), Vec3(0, 0, -1), Vec3(1, 2, -3), Vec3(1e-3, -1, 1e-3), Vec3(0, -5, 0)}) {
    const Quaternion turn = turn_from_y(direction);
    EXPECT_NEAR(turn.norm(), 1, 1e-9);
    EXPECT_LT((turn * Vec3::UnitY() - direction.normalized()).norm(), 1e-9) << direction.transpose();
    // The angle between the two, and no turn about y itself.
    EXPECT_NEAR(2 * std::acos(turn.w()), std::acos(direction.normalized().y()), 1e-6);
    EXPECT_EQ(turn.y(), 0);
  }
}

TEST(TurnFromY, TurnsAboutZWhereTheDirectionIsOpposite) {
  const Quaternion turn = turn_from_y({0, -5, 0});
  EXPECT_TRUE(turn.coeffs() == Quaternion(0, 0, 0, 1).coeffs());
}

}  // namespace
}  // namespace weft
