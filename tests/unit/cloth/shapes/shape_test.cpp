// The shapes a cloth meets: nearest surface, first hit of a way, way out. Expected values by hand from the
// figures in each test.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "cloth/shapes/shape.h"

namespace weft {
namespace {

constexpr double kRounding = 1e-14;  // coordinates are about 1 m

Eigen::Matrix3d quarter_turn_about_z() {
  return Eigen::AngleAxisd(std::numbers::pi / 2, Vec3(0, 0, 1)).toRotationMatrix();
}

TEST(ShapeSurface, OfASphere) {
  const PlacedShape ball{Sphere{2}, {1, 0, 0}};
  const Surface inside = ball.surface({1, 1.5, 0}), outside = ball.surface({4, 4, 0});
  EXPECT_NEAR(inside.distance, -0.5, kRounding);
  EXPECT_LT((inside.normal - Vec3(0, 1, 0)).norm(), kRounding);
  EXPECT_NEAR(outside.distance, 3, kRounding);  // (3, 4, 0) from the centre: 5 - 2
  EXPECT_LT((outside.normal - Vec3(0.6, 0.8, 0)).norm(), kRounding);
  EXPECT_EQ(ball.surface({1, 0, 0}).normal, Vec3(0, 1, 0));  // the centre: upwards
}

TEST(ShapeSurface, OfAHalfSpaceTurnedOnItsSide) {
  // y of its own frame is -x of the world: solid where x > 3.
  const PlacedShape wall{HalfSpace{}, {3, 7, 0}, quarter_turn_about_z()};
  const Surface surface = wall.surface({3.25, -2, 5});
  EXPECT_NEAR(surface.distance, -0.25, kRounding);
  EXPECT_LT((surface.normal - Vec3(-1, 0, 0)).norm(), kRounding);
  EXPECT_FALSE(wall.contains({2.75, 0, 0}));
}

TEST(ShapeSurface, OfABox) {
  const PlacedShape box{Box{{1, 2, 3}}, {0, 0, 0}};
  EXPECT_EQ(box.surface({0.75, 0, 0}).normal, Vec3(1, 0, 0));  // next to the face x = 1
  EXPECT_NEAR(box.surface({0.75, 0, 0}).distance, -0.25, kRounding);
  EXPECT_EQ(box.surface({0, -1.9, 0}).normal, Vec3(0, -1, 0));
  const Surface edge = box.surface({1.3, -2.4, 0});  // (0.3, -0.4) from the edge
  EXPECT_NEAR(edge.distance, 0.5, kRounding);
  EXPECT_LT((edge.normal - Vec3(0.6, -0.8, 0)).norm(), kRounding);
  // A quarter turn about z: 2 m along x, 1 m along y.
  const PlacedShape turned{Box{{1, 2, 3}}, {10, 0, 0}, quarter_turn_about_z()};
  EXPECT_NEAR(turned.surface({11.5, 0, 0}).distance, -0.5, kRounding);
  EXPECT_NEAR(turned.surface({10, 1.5, 0}).distance, 0.5, kRounding);
}

/// Around the z axis from z = -1 to 1, 0.5 m thick to each side: its own y is -z of the world.
PlacedShape lying_capsule() {
  return {
      Capsule{1, 0.5}, {0, 0, 0}, Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3(1, 0, 0)).toRotationMatrix()};
}

TEST(ShapeSurface, OfACapsule) {
  const PlacedShape limb = lying_capsule();
  const Surface side = limb.surface({0.6, 0.8, 0.9}), end = limb.surface({0, 0.6, -1.8});
  EXPECT_NEAR(side.distance, 0.5, kRounding);  // (0.6, 0.8) from the axis
  EXPECT_LT((side.normal - Vec3(0.6, 0.8, 0)).norm(), kRounding);
  EXPECT_NEAR(end.distance, 0.5, kRounding);  // (0.6, -0.8) from the end at z = -1
  EXPECT_LT((end.normal - Vec3(0, 0.6, -0.8)).norm(), kRounding);
  EXPECT_NEAR(limb.surface({0, -0.2, 0.5}).distance, -0.3, kRounding);
  const Surface axis = limb.surface({0, 0, 0.5});
  EXPECT_NEAR(axis.distance, -0.5, kRounding);
  EXPECT_NEAR(axis.normal.z(), 0, kRounding);  // across the axis
  EXPECT_NEAR(axis.normal.norm(), 1, kRounding);
}

TEST(ShapeFirstHit, OfASphere) {
  const PlacedShape ball{Sphere{0.5}, {0, 0, 0}};
  // At height 0.3 the ball begins at x = -0.4: 3.6 of 8 m.
  const auto hit = ball.first_hit({-4, 0.3, 0}, {4, 0.3, 0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 3.6 / 8, kRounding);
  EXPECT_LT((hit->normal - Vec3(-0.8, 0.6, 0)).norm(), kRounding);
  EXPECT_FALSE(ball.first_hit({-4, 0.51, 0}, {4, 0.51, 0}));  // over it
  EXPECT_FALSE(ball.first_hit({-4, 0, 0}, {-0.51, 0, 0}));    // not as far
  EXPECT_FALSE(ball.first_hit({-4, 0, 0}, {-9, 0, 0}));       // away
  EXPECT_FALSE(ball.first_hit({-0.6, 0, 0}, {-0.6, 0, 0}));   // no way at all
}

TEST(ShapeFirstHit, OfABox) {
  const PlacedShape box{Box{{1, 0.01, 1}}, {0, 0, 0}};  // a board of 2 cm
  const auto hit = box.first_hit({0.5, 1.01, 0.5}, {0.5, -0.99, 0.5});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 0.5, kRounding);
  EXPECT_EQ(hit->normal, Vec3(0, 1, 0));
  const auto side = box.first_hit({3, 0, 0}, {-1, 0, 0});
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->fraction, 0.5, kRounding);
  EXPECT_EQ(side->normal, Vec3(1, 0, 0));
  EXPECT_FALSE(box.first_hit({1.5, 1, 0}, {1.5, -1, 0}));  // beside it
  EXPECT_FALSE(box.first_hit({0, 1, 0}, {0, 0.02, 0}));    // not as far
}

TEST(ShapeFirstHit, OfAHalfSpace) {
  const PlacedShape floor{HalfSpace{}, {0, 0, 0}};
  const auto hit = floor.first_hit({5, 3, 0}, {9, -1, 0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 0.75, kRounding);
  EXPECT_EQ(hit->normal, Vec3(0, 1, 0));
  EXPECT_FALSE(floor.first_hit({0, 1, 0}, {0, 2, 0}));
}

TEST(ShapeFirstHit, OfACapsule) {
  const PlacedShape limb = lying_capsule();
  const auto side = limb.first_hit({-4, 0.3, 0.9}, {4, 0.3, 0.9});  // as of a ball of that radius
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->fraction, 3.6 / 8, kRounding);
  EXPECT_LT((side->normal - Vec3(-0.8, 0.6, 0)).norm(), kRounding);
  const auto end = limb.first_hit({0, 0.3, 5}, {0, 0.3, -3});  // at z = 1.4: 3.6 of 8 m
  ASSERT_TRUE(end);
  EXPECT_NEAR(end->fraction, 3.6 / 8, kRounding);
  EXPECT_LT((end->normal - Vec3(0, 0.6, 0.8)).norm(), kRounding);
  EXPECT_FALSE(limb.first_hit({-4, 0.3, 1.45}, {4, 0.3, 1.45}));  // past the round end
  EXPECT_FALSE(limb.first_hit({0, 0.51, -3}, {0, 0.51, 3}));      // along it, over it
}

TEST(ShapeSurface, ContainsWhatLiesBelowIt) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-1.5, 1.5), angle(0, 6);
  const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
  for (const Shape& shape :
       {Shape(Sphere{1.1}), Shape(Box{{0.4, 0.8, 1.3}}), Shape(Capsule{0.5, 0.6}), Shape(HalfSpace{})}) {
    int inside = 0;
    constexpr int kPoints = 1000;
    for (int trial = 0; trial < kPoints; ++trial) {
      const PlacedShape placed{shape, point(),
                               Eigen::AngleAxisd(angle(random), point().normalized()).toRotationMatrix()};
      const Vec3 at = point();
      const double distance = placed.surface(at).distance;
      if (std::abs(distance) < 1e-12) continue;  // rounding decides
      EXPECT_EQ(placed.contains(at), distance < 0) << shape.index();
      inside += distance < 0 ? 1 : 0;
    }
    EXPECT_GT(inside, kPoints / 20);
    EXPECT_LT(inside, kPoints - kPoints / 20);
  }
}

TEST(ShapeFirstHit, LiesOnTheSurfaceWhateverTheWay) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-3, 3), angle(0, 6);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
    PlacedShape shape{Sphere{1.1}, point()};
    if (trial % 3 == 1) shape.shape = Box{{0.4, 0.8, 1.3}};
    if (trial % 3 == 2) shape.shape = Capsule{0.9, 0.6};
    shape.rotation = Eigen::AngleAxisd(angle(random), point().normalized()).toRotationMatrix();
    const Vec3 from = point(), to = point();
    if (shape.contains(from)) continue;
    const auto hit = shape.first_hit(from, to);
    if (!hit) {  // then no point of the way is inside
      for (int i = 0; i <= 50; ++i) EXPECT_FALSE(shape.contains(from + i / 50.0 * (to - from)));
      continue;
    }
    ++hits;
    const Vec3 at = from + hit->fraction * (to - from);
    EXPECT_NEAR(shape.surface(at).distance, 0, 1e-12);
    EXPECT_LE(hit->normal.dot(to - from), 0);
  }
  EXPECT_GT(hits, 100);
}

TEST(ShapeWayOut, EndsAtTheSurface) {
  const PlacedShape ball{Sphere{2}, {0, 0, 0}}, box{Box{{1, 2, 3}}, {0, 0, 0}}, floor{HalfSpace{}, {0, 0, 0}};
  EXPECT_NEAR(ball.way_out({1, 0, 0}, {-1, 0, 0}), 3, kRounding);
  EXPECT_NEAR(box.way_out({0.5, 0, 0}, {-0.6, 0.8, 0}), 2.5, kRounding);  // both faces at 2.5 m
  EXPECT_NEAR(floor.way_out({0, -1, 0}, {0.6, 0.8, 0}), 1.25, kRounding);
  EXPECT_EQ(floor.way_out({0, -1, 0}, {1, 0, 0}), std::numeric_limits<double>::infinity());
  const PlacedShape limb = lying_capsule();
  EXPECT_NEAR(limb.way_out({0, 0.25, 0.5}, {0, 0, -1}), 1.5 + std::sqrt(0.25 - 0.0625), kRounding);  // an end
  EXPECT_NEAR(limb.way_out({0.3, 0, 0.5}, {0, -1, 0}), 0.4, kRounding);       // the side
  EXPECT_NEAR(limb.way_out({0, 0, 0}, {0.6, 0, 0.8}), 0.5 / 0.6, kRounding);  // the side at z = 0.67
}

TEST(ShapeBounds, HoldTheShape) {
  const Eigen::AlignedBox3d box = PlacedShape{Box{{1, 2, 3}}, {10, 0, 0}, quarter_turn_about_z()}.bounds();
  EXPECT_LT((box.min() - Vec3(8, -1, -3)).norm(), kRounding);
  EXPECT_LT((box.max() - Vec3(12, 1, 3)).norm(), kRounding);
  const Eigen::AlignedBox3d limb = lying_capsule().bounds();
  EXPECT_LT((limb.max() - Vec3(0.5, 0.5, 1.5)).norm(), kRounding);
  EXPECT_LT((limb.min() + Vec3(0.5, 0.5, 1.5)).norm(), kRounding);
}

}  // namespace
}  // namespace weft
