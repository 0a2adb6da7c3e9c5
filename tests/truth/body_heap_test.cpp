// Bodies on bodies: what is in balance stays, and what slides on a body slides as far as by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bodies.h"
#include "draws.h"
#include "meshes.h"

namespace weft::test {
namespace {

constexpr double kHeapGravity = 9.81;

using AnyShape = decltype(ObstacleDescription::shape);

/// A box as such, as a convex body and as a mesh.
AnyShape box_as(int kind, const Vec3& size) {
  if (kind == 0) return BoxDescription{size};
  return solid_of(box_mesh(size / 2), kind == 1);
}

/// A prism about the y axis: a can.
TriangleList can_mesh(double radius, double half, int sides) {
  TriangleList list;
  for (const double y : {-half, half}) {
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      list.vertices.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
  }
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    list.triangles.push_back({k, sides + k, sides + next});
    list.triangles.push_back({k, sides + next, next});
    if (k == 0 || next == 0) continue;
    list.triangles.push_back({0, k, next});
    list.triangles.push_back({sides, sides + next, sides + k});
  }
  return list;
}

Quaternion about_y(double angle) { return Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitY())); }

// Its top is one face and its underside another, however thin it is.
TEST(BodyHeap, ABoxLiesOnAPlateHoweverThin) {
  Draws draws;
  for (int i = 0; i < 40; ++i) {
    const double thin = std::pow(10, draws.between(-2.7, -0.5)), wide = draws.between(0.6, 4);
    const Vec3 plate(wide, thin, wide * draws.between(0.5, 1));
    const Vec3 size(draws.between(0.08, 0.3), draws.between(0.08, 0.3), draws.between(0.08, 0.3));
    BoxDescription box{size};
    box.orientation = about_y(draws.between(0, std::numbers::pi / 2));
    const Vec3 place(draws.between(-0.1, 0.1), size.y() / 2 + draws.between(0.01, 0.5),
                     draws.between(-0.1, 0.1));
    Bodies bodies({}, {standing(box_as(draws.below(3), plate), {0, -thin / 2, 0}, 0.5),
                       flying(box, place, {0, 0, 0}, 0.5)});
    bodies.dt = 1.0 / draws.one_of(std::array{30, 60});
    bodies.run(4);
    EXPECT_NEAR(bodies.obstacle(1).pose.position.y(), size.y() / 2, 1e-3) << i << ": " << plate.transpose();
    EXPECT_LT(bodies.obstacle(1).body->velocity().norm(), 1e-3) << i;
  }
}

// Above each box the common centre of all is over its middle but for 2 cm, so nothing moves them. The bound
// is a thousandth of a tower's height.
TEST(BodyHeap, ATowerStands) {
  Draws draws;
  for (int i = 0; i < 16; ++i) {
    std::vector<ObstacleDescription> all{ground(0.5)};
    double height = 0;
    const int count = 4 + draws.below(3);
    for (int k = 0; k < count; ++k) {
      const Vec3 size(draws.between(0.16, 0.28), draws.between(0.1, 0.25), draws.between(0.16, 0.28));
      BoxDescription box{size};
      box.orientation = about_y(draws.between(0, std::numbers::pi / 2));
      const Vec3 place(draws.between(-0.01, 0.01), height + size.y() / 2, draws.between(-0.01, 0.01));
      all.push_back(flying(box, place, {0, 0, 0}, 0.5, draws.between(0.3, 1)));
      height += size.y();
    }
    Bodies bodies({}, all);
    bodies.dt = 1.0 / draws.one_of(std::array{60, 120});
    bodies.run(1);
    const Vec3 top = bodies.obstacle(all.size() - 1).pose.position;
    bodies.run(5);
    EXPECT_LT((bodies.obstacle(all.size() - 1).pose.position - top).norm(), 5e-4)
        << "tower " << i << " of " << count << " at " << 1 / bodies.dt << " Hz";
  }
}

TEST(BodyHeap, ABoxSlidesOnABoxOrAMeshAsOnTheGround) {
  // As in BodyContact: in steps of h the way is v h / 2 shorter than v^2 / (2 mu g).
  Draws draws;
  for (int i = 0; i < 27; ++i) {
    const double mu = draws.between(0.1, 0.5), v = draws.between(1, 3);
    const double way = v * v / (2 * mu * kHeapGravity) - v / 120;
    const AnyShape slab = box_as(i % 3, {30, 1, 30}), body = box_as(i / 3 % 3, {0.4, 0.2, 0.4});
    Bodies bodies({}, {standing(slab, {0, -0.5, 0}, mu), flying(body, {0, 0.1, 0}, {v, 0, 0}, mu)});
    double highest = 0;
    for (int step = 0; step < 240; ++step) {
      bodies.step();
      highest = std::max(highest, bodies.obstacle(1).pose.position.y());
    }
    EXPECT_NEAR(bodies.obstacle(1).pose.position.x(), way, 0.03 * way)
        << "kind " << i / 3 % 3 << " on " << i % 3;
    EXPECT_LT(highest, 0.105) << i;  // it is not thrown up
  }
}

// They go as far in a step as their speed takes them, and are put aside by no more than they overlap.
TEST(BodyHeap, WhatLiesInAHeapIsNotPutElsewhere) {
  Draws draws;
  const AnyShape can = solid_of(can_mesh(0.08, 0.07, 24), true);
  for (int i = 0; i < 12; ++i) {
    std::vector<ObstacleDescription> all{standing(BoxDescription{{2, 2, 2}}, {0, -1, 0}, 0.5)};
    for (int k = 0; k < 4; ++k) {
      const Vec3 place(draws.between(-0.05, 0.05), 0.15 + 0.2 * k, draws.between(-0.05, 0.05));
      all.push_back(flying(can, place, {0, 0, 0}, 0.5));
      all.back().body->spin = Vec3(draws.between(-3, 3), draws.between(-3, 3), draws.between(-3, 3));
    }
    Bodies bodies({}, all);
    double farthest = 0;
    for (int step = 0; step < 180; ++step) {
      std::vector<Vec3> before;
      for (std::size_t k = 1; k < all.size(); ++k) before.push_back(bodies.obstacle(k).pose.position);
      bodies.step();
      for (std::size_t k = 1; k < all.size(); ++k) {
        const Obstacle& moved = bodies.obstacle(k);
        const Vec3 way = moved.pose.position - before[k - 1];
        farthest = std::max(farthest, (way - bodies.dt * moved.body->velocity()).norm());
      }
    }
    EXPECT_LT(farthest, 0.01) << "heap " << i;  // m
  }
}

TEST(BodyHeapNightly, DominoesThatHaveFallenRest) {
  for (const int rate : {30, 60}) {
    std::vector<ObstacleDescription> all{ground(0.5)};
    for (int i = 0; i < 25; ++i) {
      all.push_back(flying(BoxDescription{{0.02, 0.2, 0.1}}, {0.08 * i, 0.1, 0}, {0, 0, 0}, 0.5, 0.2));
    }
    BallDescription ball = flying_ball({-0.2, 0.18, 0}, 0.05, {2, 0.3, 0});
    ball.mass = 0.2;
    Bodies bodies({ball}, all);
    bodies.dt = 1.0 / rate;
    bodies.run(12);
    double fastest = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      fastest = std::max(fastest, bodies.obstacle(i).body->velocity().norm());
      EXPECT_LT(bodies.obstacle(i).pose.position.y(), 0.09) << i << " has not fallen";
    }
    EXPECT_LT(fastest, 0.01) << rate << " Hz";  // m/s
  }
}

}  // namespace
}  // namespace weft::test
