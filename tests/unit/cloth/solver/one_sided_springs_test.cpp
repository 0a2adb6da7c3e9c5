// How far along a change contacts let a step go.
#include "cloth/solver/one_sided_springs.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

constexpr double kStiffness = 1000;  // N/m
constexpr double kFound = 1.0 / 1024;

// The energy along a share t of the change is -t (2 - t) D, D the system's decrease, and
// k (depth + t approach)^2 / 2 for what is pressed though the system does not hold it, less the same for what
// pulls though it does.

TEST(BestShare, IsTheWholeWhereNothingComesInTheWay) {
  EXPECT_EQ(best_share({}, 0.5), 1);
  EXPECT_EQ(best_share({{-0.002, -0.01, kStiffness, false}}, 0.5), 1);  // away from it
  EXPECT_EQ(best_share({{-0.002, 0.001, kStiffness, false}}, 0.5), 1);  // not so far
  EXPECT_EQ(best_share({{0.002, 0.001, kStiffness, true}}, 0.5), 1);    // the system holds it
}

TEST(BestShare, EndsWhereASpringComesInTheWay) {
  // From 2 mm before it 10 mm on: least at t = (2 D + k a L) / (2 D + k L^2).
  for (const double decrease : {0.001, 0.02, 0.5}) {
    const double least = (2 * decrease + kStiffness * 0.002 * 0.01) / (2 * decrease + kStiffness * 1e-4);
    EXPECT_NEAR(best_share({{-0.002, 0.01, kStiffness, false}}, decrease), least, kFound) << decrease << " J";
  }
}

TEST(BestShare, DoesNotGoWhereOnlyAPullingSpringLeads) {
  // It draws a node 2 mm nearer, and nothing else does: D = k d^2 / 2 is the spring's own. Without it nothing
  // changes along the way, so the whole is as good as any.
  EXPECT_EQ(best_share({{-0.002, 0.002, kStiffness, true}}, kStiffness * 0.002 * 0.002 / 2), 1);
  // It holds a node back that goes 1 mm farther off: the system ends at 1, the energy falls on.
  EXPECT_EQ(best_share({{-0.002, -0.001, kStiffness, true}}, 1e-5), 1);
}

TEST(BestShare, OfSeveralSpringsIsWhereTheirForcesAreInBalance) {
  // Two in the way, at 2 and at 4 mm of 10: t = (2 D + k L (a + b)) / (2 D + 2 k L^2), beyond both.
  const double decrease = 0.2, length = 0.01;
  const double least =
      (2 * decrease + kStiffness * length * 0.006) / (2 * decrease + 2 * kStiffness * length * length);
  ASSERT_GT(least, 0.4);
  EXPECT_NEAR(
      best_share({{-0.002, length, kStiffness, false}, {-0.004, length, kStiffness, false}}, decrease), least,
      kFound);
}

}  // namespace
}  // namespace weft
