// Nearest points of a node and a triangle and of two edges, by hand. When they meet is in
// layer_search_test.cpp.
#include "cloth/contact/search/features.h"

#include <gtest/gtest.h>

#include <numeric>

namespace weft::test {
namespace {

using FeatureKind = FeaturePair::Kind;

/// The triangle (0,0,0), (1,0,0), (0,0,1), whose normal is -y or y, and a node.
FourPoints over_triangle(const Vec3& node) { return {node, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}; }

double sum_of_weights(const std::array<double, 4>& weight) {
  return std::accumulate(weight.begin(), weight.end(), 0.0);
}

TEST(NearestPoints, OfANodeOverATriangle) {
  const Nearness near = nearness(FeatureKind::node_triangle, over_triangle({0.25, 0.1, 0.5}));
  EXPECT_NEAR((near.apart - Vec3(0, 0.1, 0)).norm(), 0, 1e-15);
  // (0.25, 0, 0.5) is a quarter, a quarter and a half of its corners.
  EXPECT_DOUBLE_EQ(near.weight[0], 1);
  EXPECT_NEAR(near.weight[1], -0.25, 1e-15);
  EXPECT_NEAR(near.weight[2], -0.25, 1e-15);
  EXPECT_NEAR(near.weight[3], -0.5, 1e-15);
}

TEST(NearestPoints, OfANodeBesideATriangle) {
  // Beside the corner (1,0,0), and beside the edge from there to (0,0,1).
  EXPECT_NEAR((nearness(FeatureKind::node_triangle, over_triangle({2, 1, 0})).apart - Vec3(1, 1, 0)).norm(),
              0, 1e-15);
  const Nearness edge = nearness(FeatureKind::node_triangle, over_triangle({1, 0, 1}));
  EXPECT_NEAR((edge.apart - Vec3(0.5, 0, 0.5)).norm(), 0, 1e-15);
  EXPECT_NEAR(edge.weight[1], 0, 1e-15);
  EXPECT_NEAR(sum_of_weights(edge.weight), 0, 1e-15);
}

TEST(NearestPoints, OfEdgesThatCross) {
  // Along x through (0, 0.2, 0) and along z through the origin, crossed a quarter and a half on their ways.
  const FourPoints edges{Vec3(-1, 0.2, 0), Vec3(3, 0.2, 0), Vec3(0, 0, -1), Vec3(0, 0, 1)};
  const Nearness near = nearness(FeatureKind::edge_edge, edges);
  EXPECT_NEAR((near.apart - Vec3(0, 0.2, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(near.weight[0], 0.75, 1e-15);
  EXPECT_NEAR(near.weight[1], 0.25, 1e-15);
  EXPECT_NEAR(near.weight[2], -0.5, 1e-15);
  EXPECT_NEAR(near.weight[3], -0.5, 1e-15);
}

TEST(NearestPoints, OfWhatHasShrunkToAPoint) {
  const Vec3 point(1, 2, 3), node(1, 2, 5);
  EXPECT_NEAR(
      (nearness(FeatureKind::node_triangle, {node, point, point, point}).apart - Vec3(0, 0, 2)).norm(), 0,
      1e-15);
  EXPECT_NEAR((nearness(FeatureKind::edge_edge, {node, node, point, point}).apart - Vec3(0, 0, 2)).norm(), 0,
              1e-15);
}

TEST(ContactNormal, IsTheTrianglesWhereTheNodeIsOverIt) {
  const auto normal = [](const Vec3& node) {
    const FourPoints points = over_triangle(node);
    return contact_normal(FeatureKind::node_triangle, points, nearness(FeatureKind::node_triangle, points));
  };
  EXPECT_NEAR((normal({0.2, 0.1, 0.2}) - Vec3(0, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((normal({0.2, -0.1, 0.2}) - Vec3(0, -1, 0)).norm(), 0, 1e-12) << "towards the node";
  EXPECT_NEAR((normal({-0.05, 0.1, 0.2}) - Vec3(0, 1, 0)).norm(), 0, 1e-12) << "beyond its rim by less";
  EXPECT_NEAR((normal({-0.3, 0.1, 0.2}) - Vec3(-0.3, 0.1, 0).normalized()).norm(), 0, 1e-12) << "by more";
}

TEST(Reach, IsWhatTheFeaturesMayComeNearer) {
  const Vec3 common(5, 6, 7);
  // The node comes 2 m down and the triangle's farthest corner 1 m up, beside what both do.
  const FourPoints move{common + Vec3(0, -2, 0), common, common + Vec3(0, 1, 0), common};
  const double bound = reach(FeatureKind::node_triangle, move);
  EXPECT_GE(bound, 3 - 1e-12);
  FourPoints same = move;
  for (Vec3& each : same) each -= common;
  EXPECT_NEAR(reach(FeatureKind::node_triangle, same), bound, 1e-12);
  EXPECT_NEAR(reach(FeatureKind::edge_edge, {common, common, common, common}), 0, 1e-12);
}

}  // namespace
}  // namespace weft::test
