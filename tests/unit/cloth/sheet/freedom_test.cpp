// Which rigid motions pushes leave free, and what of a momentum belongs to them.
#include "cloth/sheet/freedom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft {
namespace {

using Screw = Freedom::Screw;

constexpr double kBodyMass = 2;  // kg
const Vec3 kMiddle(3, 1, -2);
const Eigen::Matrix3d kInertia = Vec3(0.3, 0.5, 0.4).asDiagonal();  // kg m2

Screw screw(const Vec3& linear, const Vec3& angular) {
  Screw both;
  both << linear, angular;
  return both;
}
/// Momenta of a body that moves so.
Screw momenta(const Vec3& velocity, const Vec3& spin) { return screw(kBodyMass * velocity, kInertia * spin); }
void expect_near(const Screw& found, const Screw& expected) {
  EXPECT_LT((found - expected).norm(), 1e-9) << found.transpose() << " instead of " << expected.transpose();
}
/// A ring of pushes about the centre, in the plane of x and z.
std::vector<Push> ring(const auto& normal) {
  std::vector<Push> pushes;
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::numbers::pi / 6;
    const Vec3 arm(std::cos(angle), 0, std::sin(angle));
    pushes.push_back({kMiddle + arm, normal(arm)});
  }
  return pushes;
}

TEST(Freedom, WithoutPushesAllMotionIsFree) {
  const Freedom free = Freedom::beside({}, kMiddle, 1);
  EXPECT_TRUE(free.is_all());
  const Screw motion = screw({1, 2, 3}, {-1, 0, 2});
  expect_near(free.motion(momenta({1, 2, 3}, {-1, 0, 2}), kBodyMass, kInertia), motion);
}

TEST(Freedom, OfAHeldClothNoneIs) {
  EXPECT_TRUE(Freedom::none().is_none());
  expect_near(Freedom::none().motion(momenta({1, 2, 3}, {-1, 0, 2}), kBodyMass, kInertia), Screw::Zero());
}

// A floor leaves sliding along it, and turning about its normal.
TEST(Freedom, AFloorLeavesWhatSlides) {
  const Freedom free = Freedom::beside(ring([](const Vec3&) { return Vec3(0, 1, 0); }), kMiddle, 1);
  EXPECT_FALSE(free.is_all());
  expect_near(free.motion(momenta({1, 2, 3}, {-1, 4, 2}), kBodyMass, kInertia), screw({1, 0, 3}, {0, 4, 0}));
}

// On one point it may also tip about that: of a push through the centre nothing but the way along it goes.
TEST(Freedom, OnePointTakesOneMotion) {
  const Freedom free = Freedom::beside({{kMiddle + Vec3(0, -0.5, 0), {0, 1, 0}}}, kMiddle, 1);
  expect_near(free.motion(momenta({1, 2, 3}, {-1, 4, 2}), kBodyMass, kInertia), screw({1, 0, 3}, {-1, 4, 2}));
}

// A ring about a ball leaves turning about the ball's centre: of a push of momentum along x what turns it.
// With the ball's centre 1 m below, v = w x (0, 1, 0): from p = m v and L = I w the motion has
// w_z = (L_z - p_x) / (I_z + m).
TEST(Freedom, ABallLeavesTurningAboutItsCentre) {
  const Vec3 ball = kMiddle - Vec3(0, 1, 0);
  const Freedom free = Freedom::beside(
      ring([&](const Vec3& arm) { return Vec3((kMiddle + arm - ball).normalized()); }), kMiddle, 1);
  const Screw motion = free.motion(screw({1.5, 0, 0}, {0, 0, 0.7}), kBodyMass, kInertia);
  const double spin = (0.7 - 1.5) / (0.4 + kBodyMass);
  expect_near(motion, screw({-spin, 0, 0}, {0, 0, spin}));
}

// Walls and a floor leave nothing.
TEST(Freedom, ABoxLeavesNone) {
  std::vector<Push> pushes = ring([](const Vec3&) { return Vec3(0, 1, 0); });
  for (const Push& push : ring([](const Vec3&) { return Vec3(1, 0, 0); })) pushes.push_back(push);
  for (const Push& push : ring([](const Vec3&) { return Vec3(0, 0, 1); })) pushes.push_back(push);
  EXPECT_TRUE(Freedom::beside(pushes, kMiddle, 1).is_none());
}

}  // namespace
}  // namespace weft
