// Whether a sphere is in sight, against figures worked out by hand and against points of the cone itself.
#include "cloth/levels/view_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "cloth/shapes/bounding_sphere.h"
#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ViewCone, TouchesWhatItsSideAndItsEyeTouch) {
  // From (1, 2, 3) along -z, 30 degrees to each side.
  const ViewCone cone{{1, 2, 3}, {0, 0, -1}, kPi / 6};
  const auto touches = [&](const Vec3& from_eye, double radius) {
    return cone.touches({cone.eye + from_eye, radius});
  };
  EXPECT_TRUE(touches({0, 0, -4}, 0));
  EXPECT_TRUE(touches({0, 0, -4e5}, 0)) << "it has no end";
  // 4 m ahead the cone is 4 tan 30 = 2.3094 m wide; what is 3 m aside is 3 cos 30 - 4 sin 30 = 0.5981 m from
  // its side, in whatever direction aside it is.
  for (const Vec3& aside : {Vec3(3, 0, 0), Vec3(-3, 0, 0), Vec3(0, 3, 0), Vec3(1.8, -2.4, 0)}) {
    EXPECT_TRUE(touches(aside * (2.309 / 3) - Vec3(0, 0, 4), 0));
    EXPECT_FALSE(touches(aside * (2.310 / 3) - Vec3(0, 0, 4), 0));
    EXPECT_FALSE(touches(aside - Vec3(0, 0, 4), 0.598));
    EXPECT_TRUE(touches(aside - Vec3(0, 0, 4), 0.5982));
  }
  // Behind the eye it is the eye that is nearest: 5 m from (3, 0, 4).
  EXPECT_FALSE(touches({3, 0, 4}, 4.999));
  EXPECT_TRUE(touches({3, 0, 4}, 5.001));
  // Beside the eye the side is nearest up to 120 degrees off the axis: at 90 it is 2 cos 30 = 1.7321 m away.
  EXPECT_FALSE(touches({0, 2, 0}, 1.732));
  EXPECT_TRUE(touches({0, 2, 0}, 1.7321));
  EXPECT_TRUE(touches({0, 0, 0.5}, 0.5)) << "the viewer stands on its rim";
}

TEST(ViewCone, MayBeWiderThanAHalfSpace) {
  // 135 degrees to each side: all but what lies within 45 degrees of straight behind.
  const ViewCone cone{{0, 0, 0}, {1, 0, 0}, 0.75 * kPi};
  EXPECT_TRUE(cone.touches({{0, 0, 7}, 0}));
  EXPECT_TRUE(cone.touches({{-1, 1.001, 0}, 0}));
  EXPECT_FALSE(cone.touches({{-1, 0.999, 0}, 0}));
  EXPECT_FALSE(cone.touches({{-2, 0, 0}, 1.414}));  // its side is 2 sin 45 = 1.4142 m away
  EXPECT_TRUE(cone.touches({{-2, 0, 0}, 1.4143}));
  EXPECT_TRUE((ViewCone{{0, 0, 0}, {1, 0, 0}, kPi}.touches({{-2, 1e-3, 0}, 0}))) << "everything";
}

TEST(ViewCone, AgreesWithItsOwnPoints) {
  // The least distance to 200,000 points on rays of the cone, which is what the formula must know.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int checked = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double half_angle = 0.1 + 1.3 * (uniform(random) + 1);  // 0.1..2.7 rad
    const ViewCone cone{{0, 0, 0}, {0, 0, 1}, half_angle};
    const Vec3 centre(2 * uniform(random), 0, 2 * uniform(random));
    double least = centre.norm();
    for (int ray = 0; ray <= 200; ++ray) {  // the nearest ray is in the plane of axis and centre
      const double angle = half_angle * (ray - 100) / 100;
      for (int step = 0; step <= 1000; ++step) {
        least = std::min(least, (centre - 0.004 * step * Vec3(std::sin(angle), 0, std::cos(angle))).norm());
      }
    }
    if (least < 0.1) continue;  // points that are this near to each other do not tell
    EXPECT_TRUE(cone.touches({centre, least + 1e-9})) << half_angle << ", " << centre.transpose();
    EXPECT_FALSE(cone.touches({centre, least - 1e-4})) << half_angle << ", " << centre.transpose();
    ++checked;
  }
  EXPECT_GT(checked, 5);
}

TEST(BoundingSphere, HoldsAllNodesAndIsCentredOnThem) {
  // A sheet of 2 m x 1 m around the origin: half its diagonal, sqrt(5) / 2 m.
  Particles<float> sheet = test::flat_sheet<float>(5, 9, {2, 1});
  EXPECT_LT(bounding_sphere(sheet).centre.norm(), 1e-6);
  EXPECT_NEAR(bounding_sphere(sheet).radius, 1.1180340, 1e-6);
  // One of the 45 nodes 9 m up from (1, 0.5, 0): the mean rises by 0.2 m, from which it is as far as this.
  test::set(sheet.position, 0, 8, {1, 0.5, 9});
  EXPECT_LT((bounding_sphere(sheet).centre - Vec3(0, 0, 0.2)).norm(), 1e-6);
  EXPECT_NEAR(bounding_sphere(sheet).radius, std::sqrt(1 + 0.25 + 8.8 * 8.8), 1e-6);
}

}  // namespace
}  // namespace weft
