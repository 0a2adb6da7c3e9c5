#include "cloth/shapes/triangle_octree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "meshes.h"

namespace weft {
namespace {

std::vector<Triangle> triangles_of(const TriangleList& list) {
  std::vector<Triangle> triangles;
  triangles.reserve(list.triangles.size());
  for (const auto& t : list.triangles) {
    const Vec3 &a = list.vertices[std::size_t(t[0])], &b = list.vertices[std::size_t(t[1])],
               &c = list.vertices[std::size_t(t[2])];
    triangles.push_back({{a, b, c}, (b - a).cross(c - a).normalized()});
  }
  return triangles;
}

/// A torus around the y axis, 0.5 m and its tube 0.2 m, of 1440 triangles; or a ball of half a metre.
struct OctreeOf {
  explicit OctreeOf(bool ball)
      : triangles(triangles_of(
            TriangleMesh(ball ? test::sphere_mesh(0.5, 24, 30) : test::torus_mesh(0.5, 0.2, 24, 30)).list())),
        tree(triangles, ball, [ball](const Vec3& point, const TriangleOctree::Nearest&) {
          const double out = std::hypot(std::hypot(point.x(), point.z()) - 0.5, point.y());
          return ball ? point.norm() < 0.5 : out < 0.2;
        }) {}
  OctreeOf(const OctreeOf&) = delete;  // the tree refers to the triangles

  /// By looking at all.
  double distance(const Vec3& point) const {
    double square = 1e300;
    for (const Triangle& each : triangles) {
      square = std::min(square, (nearest_on(each, point).point - point).squaredNorm());
    }
    return std::sqrt(square);
  }

  std::vector<Triangle> triangles;
  TriangleOctree tree;
};

/// In a cube of 2 m about the surface, every second one near the surface itself.
std::vector<Vec3> points_about(const std::vector<Triangle>& triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> points;
  points.reserve(300);
  for (std::size_t i = 0; i < 300; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    const Triangle& on = triangles[random() % triangles.size()];
    points.push_back(i % 2 == 0 ? Vec3(x, y, z) : Vec3(on.corner[0] + 0.02 * Vec3(x, y, z)));
  }
  return points;
}

TEST(TriangleOctree, TheNearestIsTheNearestOfAll) {
  for (const bool ball : {false, true}) {
    const OctreeOf surface(ball);
    for (const Vec3& point : points_about(surface.triangles, 1)) {
      const double expected = surface.distance(point);
      const TriangleOctree::Nearest found = surface.tree.nearest(point, surface.tree.cell_at(point));
      ASSERT_NEAR(std::sqrt(found.square), expected, 1e-12);
      const Vec3 on = nearest_on(surface.triangles[found.triangle], point).point;
      ASSERT_NEAR((on - point).norm(), expected, 1e-12);
      ASSERT_LT((found.found.point - on).norm(), 1e-12);
    }
  }
}

TEST(TriangleOctree, TheSurfaceIsNoNearerThanTheClearance) {
  const OctreeOf torus(false);
  int clear = 0;
  for (const Vec3& point : points_about(torus.triangles, 2)) {
    const double clearance = torus.tree.clearance(point, torus.tree.cell_at(point));
    ASSERT_LE(clearance, torus.distance(point));
    clear += clearance > 0 ? 1 : 0;
  }
  EXPECT_GT(clear, 75);  // it says something of most that are far
}

TEST(TriangleOctree, BeyondAllCellsThereIsNone) {
  const OctreeOf torus(false);
  EXPECT_EQ(torus.tree.cell_at({0, 0.9, 0}), nullptr);
  EXPECT_EQ(torus.tree.cell_at({5, 0, 0}), nullptr);
  EXPECT_NE(torus.tree.cell_at({0.5, 0.2, 0}), nullptr);
  const Vec3 far(3, 1, -2);
  EXPECT_LE(torus.tree.clearance(far, nullptr), torus.distance(far));
  EXPECT_GT(torus.tree.clearance(far, nullptr), 1);
  EXPECT_NEAR(std::sqrt(torus.tree.nearest(far, nullptr).square), torus.distance(far), 1e-12);
}

// Cells that the surface keeps off lie on one side of it; the torus' hole is outside.
TEST(TriangleOctree, CellsTellTheirSide) {
  const OctreeOf torus(false);
  int inside = 0, outside = 0;
  for (const Vec3& point : points_about(torus.triangles, 3)) {
    const TriangleOctree::Cell* cell = torus.tree.cell_at(point);
    if (cell == nullptr || cell->side == TriangleOctree::Side::crossed) continue;
    const bool within = std::hypot(std::hypot(point.x(), point.z()) - 0.5, point.y()) < 0.2;
    ASSERT_EQ(cell->side == TriangleOctree::Side::inside, within) << point.transpose();
    (within ? inside : outside) += 1;
  }
  const Vec3 hole(0, 0, 0);
  EXPECT_EQ(torus.tree.cell_at(hole)->side, TriangleOctree::Side::outside);
  EXPECT_GT(outside, 20);
  const TriangleOctree::Cell* tube = torus.tree.cell_at({0.5, 0, 0});
  EXPECT_EQ(tube->side, TriangleOctree::Side::inside);
}

// Of a convex body what lies below the planes of all its triangles is inside.
TEST(TriangleOctree, InConvexCellsAPointBelowAllPlanesIsInside) {
  const OctreeOf ball(true);
  int below = 0, above = 0;
  for (const Vec3& point : points_about(ball.triangles, 4)) {
    const TriangleOctree::Cell* cell = ball.tree.cell_at(point);
    if (cell == nullptr || cell->count == 0) continue;
    EXPECT_TRUE(cell->convex);
    const bool inside = std::all_of(ball.triangles.begin(), ball.triangles.end(), [&](const Triangle& each) {
      return each.normal.dot(point - each.corner[0]) < 0;
    });
    ASSERT_EQ(ball.tree.is_below_all(point, *cell), inside);
    (inside ? below : above) += 1;
  }
  EXPECT_GT(below, 20);
  EXPECT_GT(above, 20);
}

// None that the way crosses is missing, be it within a cell, through all of them or from beyond.
TEST(TriangleOctree, AWayIsToldAllTrianglesThatItCrosses) {
  const OctreeOf torus(false);
  const std::vector<Vec3> points = points_about(torus.triangles, 5);
  std::size_t crossed = 0, told = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 &from = points[i], to = i % 3 == 0 ? Vec3(from + 0.03 * points[i + 1]) : points[i + 1];
    std::set<std::size_t> found;
    torus.tree.for_each_along(from, to, [&](std::size_t triangle) { found.insert(triangle); });
    told += found.size();
    const WayAcross way(from, to - from);
    for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
      const auto at = way.crossing(torus.triangles[t]);
      if (!at || *at < 0 || *at > 1) continue;
      ++crossed;
      ASSERT_TRUE(found.contains(t)) << i;
    }
  }
  EXPECT_GT(crossed, 100U);
  EXPECT_LT(told, points.size() * torus.triangles.size() / 4);  // not simply all
}

}  // namespace
}  // namespace weft
