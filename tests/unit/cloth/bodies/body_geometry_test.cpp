#include "cloth/bodies/body_geometry.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include <random>

#include "meshes.h"

namespace weft {
namespace {

Solid turned_solid(const Shape& shape) {
  Solid solid;
  solid.shape = shape;
  solid.start = {-3, 1, 0};
  solid.position = {1, 2, -1};
  solid.rotation = Eigen::AngleAxisd(0.8, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  solid.turn = {0, 0.3, 0};
  return solid;
}

/// FCL sees a speck at that point in the solid's geometry, or on its surface if that is hollow.
bool fcl_has(const BodyGeometry::Geometry& geometry, const Solid& solid, const Vec3& point, double radius) {
  const fcl::Sphered speck(radius);
  fcl::Transform3d at = fcl::Transform3d::Identity();
  at.translation() = point;
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  fcl::collide(&speck, at, geometry.get(), end_of(solid), request, result);
  return result.isCollision();
}

TEST(BodyGeometry, BallsAndHalfSpacesHaveNone) {
  BodyGeometry geometry;
  EXPECT_EQ(geometry.of(turned_solid(Sphere{0.2})), nullptr);
  EXPECT_EQ(geometry.of(turned_solid(HalfSpace{})), nullptr);
}

TEST(BodyGeometry, ShapesHaveTheirMeasures) {
  BodyGeometry geometry;
  const auto box = std::dynamic_pointer_cast<fcl::Boxd>(geometry.of(turned_solid(Box{{0.1, 0.2, 0.3}})));
  ASSERT_NE(box, nullptr);
  EXPECT_LT((box->side - Vec3(0.2, 0.4, 0.6)).norm(), 1e-15);
  const auto capsule =
      std::dynamic_pointer_cast<fcl::Capsuled>(geometry.of(turned_solid(Capsule{0.25, 0.1})));
  ASSERT_NE(capsule, nullptr);
  EXPECT_EQ(capsule->radius, 0.1);
  EXPECT_EQ(capsule->lz, 0.5);  // of the stretch between the round ends
}

// Points in and about a turned solid are where FCL has its geometry as well, at the step's end.
TEST(BodyGeometry, LiesWhereTheSolidEnds) {
  TriangleList convex_list = test::box_mesh({0.3, 0.1, 0.2});
  convex_list.convex = true;
  const TriangleMesh convex(convex_list);
  BodyGeometry geometry;
  for (const Shape& shape : {Shape(Box{{0.3, 0.1, 0.2}}), Shape(Capsule{0.3, 0.1}), Shape(Mesh{&convex})}) {
    const Solid solid = turned_solid(shape);
    const PlacedShape placed = solid.placed(1);
    const BodyGeometry::Geometry fcl_geometry = geometry.of(solid);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(-0.4, 0.4);
    int inside = 0, outside = 0;
    for (int i = 0; i < 500; ++i) {
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      const Vec3 point = solid.position + Vec3(x, y, z);
      const double distance = placed.surface(point).distance;
      if (std::abs(distance) < 2e-3) continue;
      EXPECT_EQ(fcl_has(fcl_geometry, solid, point, 1e-3), distance < 0) << shape.index();
      (distance < 0 ? inside : outside) += 1;
    }
    EXPECT_GT(inside, 5);
    EXPECT_GT(outside, 5);
  }
}

// A mesh that is not known to be convex is a surface: nothing within it.
TEST(BodyGeometry, AMeshThatIsNotConvexIsHollow) {
  const TriangleMesh torus(test::torus_mesh(0.3, 0.1, 12, 16));
  BodyGeometry geometry;
  const Solid solid = turned_solid(Mesh{&torus});
  const Vec3 middle = solid.position + solid.rotation * Vec3(0.3, 0, 0),
             surface = solid.position + solid.rotation * Vec3(0.4, 0, 0);
  EXPECT_FALSE(fcl_has(geometry.of(solid), solid, middle, 0.01));
  EXPECT_TRUE(fcl_has(geometry.of(solid), solid, surface, 0.01));
}

TEST(BodyGeometry, AMeshIsLaidOutOnce) {
  const TriangleMesh torus(test::torus_mesh(0.3, 0.1, 8, 8)), other(test::torus_mesh(0.3, 0.1, 8, 8));
  BodyGeometry geometry;
  const BodyGeometry::Geometry first = geometry.of(turned_solid(Mesh{&torus}));
  EXPECT_EQ(geometry.of(turned_solid(Mesh{&torus})), first);
  EXPECT_NE(geometry.of(turned_solid(Mesh{&other})), first);
}

}  // namespace
}  // namespace weft
