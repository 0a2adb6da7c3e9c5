#include "cloth/bodies/polytope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes.h"

namespace weft {
namespace {

PlacedShape box_at(const Vec3& half, const Vec3& centre, double tilt = 0) {
  return {Box{half}, centre, Eigen::AngleAxisd(tilt, Vec3::UnitX()).toRotationMatrix()};
}

TEST(Polytope, ReachesAsFarAsItsFarthestCorner) {
  const Polytope box(box_at({1, 2, 3}, {10, 0, 0}));
  EXPECT_DOUBLE_EQ(box.reach(Vec3::UnitX()), 11);
  EXPECT_DOUBLE_EQ(box.reach(-Vec3::UnitX()), -9);
  const Polytope capsule({Capsule{0.5, 0.1}, {0, 0, 0}});
  EXPECT_DOUBLE_EQ(capsule.reach(Vec3::UnitY()), 0.6);
  EXPECT_TRUE(capsule.faces().empty());
}

// Turned by 3 degrees, 0.05 rad: a corner of the underside is then not far below those of the top.
TEST(Polytope, TheTopOfAThinPlateIsOneFace) {
  const double tilt = 0.05;
  const Polytope plate(box_at({2, 0.01, 2}, {0, 0, 0}, tilt));
  const std::vector<Vec3> top = plate.facing(Vec3::UnitY(), 0.1);
  ASSERT_EQ(top.size(), 4U);
  const Vec3 normal(0, std::cos(tilt), std::sin(tilt));
  for (const Vec3& corner : top) EXPECT_NEAR(normal.dot(corner), 0.01, 1e-12);
}

TEST(Polytope, WithoutAFaceThereItIsAnEdgeOrACorner) {
  const Polytope on_edge(box_at({2, 1, 1}, {0, 0, 0}, std::numbers::pi / 4));
  EXPECT_EQ(on_edge.facing(Vec3::UnitY(), 0.1).size(), 2U);
  EXPECT_EQ(on_edge.facing(Vec3(1, 1, 0).normalized(), 0.01).size(), 1U);
}

TEST(Polytope, TheTrianglesOfAConvexMeshMakeUpItsFaces) {
  TriangleList list = test::box_mesh({1, 2, 3});
  list.convex = true;
  const TriangleMesh mesh(list);
  const Polytope box({Mesh{&mesh}, {10, 0, 0}});
  ASSERT_EQ(box.faces().size(), 6U);
  for (const Face& face : box.faces()) {
    EXPECT_DOUBLE_EQ(face.normal.cwiseAbs().maxCoeff(), 1);
    EXPECT_DOUBLE_EQ(face.height, box.reach(face.normal));
  }
  EXPECT_TRUE(Polytope({Sphere{1}, {0, 0, 0}}).faces().empty());
  EXPECT_EQ(box.facing(Vec3::UnitY(), 0.1).size(), 4U);
}

// One lies on the other by 1 mm, and is told that it overlaps it sideways.
TEST(LeastOverlap, AWrongNormalIsLeftForThatOfTheFace) {
  const Polytope upper(box_at({0.1, 0.1, 0.1}, {0.3, 0.099, 0})), lower(box_at({1, 1, 1}, {0, -1, 0}));
  EXPECT_EQ(least_overlap(upper, lower, Vec3::UnitX()), Vec3(0, 1, 0));
}

TEST(PartingFace, IsTheOneThatPartsThemMost) {
  const Polytope a(box_at({1, 1, 1}, {2.1, 2.3, 0})), b(box_at({1, 1, 1}, {0, 0, 0}));
  EXPECT_EQ(parting_face(a, b), Vec3(0, 1, 0));
  EXPECT_EQ(parting_face(b, a), Vec3(0, -1, 0));
  EXPECT_FALSE(parting_face(a, Polytope(box_at({1, 1, 1}, {1, 1, 0}))));  // they overlap
}

// Along the other it is 3 % less.
TEST(LeastOverlap, OneThatIsAsGoodIsKept) {
  const Polytope a(box_at({1, 1, 1}, {1.900, 1.903, 0})), b(box_at({1, 1, 1}, {0, 0, 0}));
  EXPECT_EQ(least_overlap(a, b, Vec3::UnitX()), Vec3(1, 0, 0));
  EXPECT_EQ(least_overlap(a, b, Vec3::UnitY()), Vec3(0, 1, 0));
}

}  // namespace
}  // namespace weft
