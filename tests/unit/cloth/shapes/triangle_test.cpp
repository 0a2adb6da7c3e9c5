#include "cloth/shapes/triangle.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

/// (0, 0), (4, 0) and (0, 3) in the plane z = 0.
const Triangle kTriangle{{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 3, 0)}, Vec3(0, 0, 1)};

// One point for each of the seven regions, with its foot.
TEST(Triangle, TellsTheNearestPointAndWhatItIsOn) {
  struct Case {
    Vec3 point, foot;
    int feature;
  };
  const Case cases[] = {{{-1, -2, 1}, {0, 0, 0}, 0},
                        {{6, -1, 2}, {4, 0, 0}, 1},
                        {{-1, 5, 0}, {0, 3, 0}, 2},
                        {{1.5, -2, 1}, {1.5, 0, 0}, 3},
                        {{2 + 3, 1.5 + 4, 0}, {2, 1.5, 0}, 4},  // along the long side's normal, (3, 4) / 5
                        {{-2, 1, 3}, {0, 1, 0}, 5},
                        {{1, 1, -7}, {1, 1, 0}, int(Feature::face)}};
  for (const Case& each : cases) {
    const NearestOnTriangle found = nearest_on(kTriangle, each.point);
    EXPECT_LT((found.point - each.foot).norm(), 1e-12) << each.point.transpose();
    EXPECT_EQ(found.feature, each.feature) << each.point.transpose();
  }
}

TEST(Triangle, IsCrossedByAWayThroughIt) {
  const WayAcross way(Vec3(1, 1, 2), Vec3(0, 0, -8));
  EXPECT_DOUBLE_EQ(way.crossing(kTriangle).value_or(-1), 0.25);
  EXPECT_FALSE(WayAcross(Vec3(3, 3, 2), Vec3(0, 0, -8)).crossing(kTriangle));
  EXPECT_FALSE(WayAcross(Vec3(-1, 1, 0), Vec3(8, 0, 0)).crossing(kTriangle));  // in its plane
}

// A way through the edge that two triangles share crosses one of them at least: watertight.
TEST(Triangle, AWayThroughASharedEdgeDoesNotSlipBetween) {
  const Triangle other{{Vec3(4, 0, 0), Vec3(4, 3, 0), Vec3(0, 3, 0)}, Vec3(0, 0, 1)};
  for (int i = 1; i < 1000; ++i) {
    const Vec3 on = kTriangle.corner[1] + i / 1000.0 * (kTriangle.corner[2] - kTriangle.corner[1]);
    const Vec3 from(0.3, 0.2 + 1e-3 * i, 5);
    const WayAcross way(from, 2 * (on - from));
    EXPECT_TRUE(way.crossing(kTriangle) || way.crossing(other)) << i;
  }
}

}  // namespace
}  // namespace weft
