// Where bodies meet, and that they do so in a simulation: order, manifolds, cloth between, reset, commands.
#include "cloth/bodies/body_collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "bodies.h"
#include "busy_scene.h"
#include "cloth/bodies/body_contact.h"
#include "cloth/bodies/contact_manifold.h"
#include "cloth/world/state_hash.h"
#include "meshes.h"

namespace weft {
namespace {

using test::flying;
using test::flying_ball;
using test::ground;
using test::run;
using test::standing;

constexpr double kHalfTurn = std::numbers::pi;

Solid solid_of(const Shape& shape, const Vec3& position, double mass = 1) {
  Solid solid;
  solid.shape = shape;
  solid.start = solid.position = position;
  solid.inverse_mass = mass > 0 ? 1 / mass : 0;
  return solid;
}

// --- Manifolds ---

TEST(Manifold, OfABoxOnALargerOneIsItsFourLowerCorners) {
  const PlacedShape small{Box{{0.2, 0.1, 0.3}}, {0.5, 0.09, 0}}, large{Box{{1, 0.5, 1}}, {0, -0.5, 0}};
  const Manifold manifold = manifold_of(small, large, {0, 1, 0}, {0.5, 0, 0}, 0.05);
  EXPECT_LT((manifold.normal - Vec3(0, 1, 0)).norm(), 1e-15);
  ASSERT_EQ(manifold.points.size(), 4u);
  for (const Manifold::Point& point : manifold.points) {
    EXPECT_NEAR(point.gap, -0.01, 1e-15);
    EXPECT_NEAR(std::abs(point.place.x() - 0.5), 0.2, 1e-15);
    EXPECT_NEAR(std::abs(point.place.z()), 0.3, 1e-15);
  }
}

TEST(Manifold, OfFacesThatCrossIsTheirCommonPart) {
  // Planks 2 x 0.2 m across each other: a square of 0.2 m, by edges alone.
  const PlacedShape a{Box{{1, 0.1, 0.1}}, {0, 0.2, 0}}, b{Box{{0.1, 0.1, 1}}, {0, 0, 0}};
  const Manifold manifold = manifold_of(a, b, {0, 1, 0}, {0, 0.1, 0}, 0.05);
  ASSERT_EQ(manifold.points.size(), 4u);
  for (const Manifold::Point& point : manifold.points) {
    EXPECT_LT((point.place.cwiseAbs() - Vec3(0.1, 0.1, 0.1)).norm(), 1e-15);
    EXPECT_NEAR(point.gap, 0, 1e-15);
  }
}

TEST(Manifold, OfACapsuleThatLiesOnABoxIsTheEndsOfWhatIsOverIt) {
  const Eigen::Matrix3d lying = Eigen::AngleAxisd(kHalfTurn / 2, Vec3::UnitZ()).toRotationMatrix();
  const PlacedShape capsule{Capsule{2, 0.1}, {0, 0.59, 0}, lying}, box{Box{{1, 0.5, 1}}};
  const Manifold manifold = manifold_of(capsule, box, {0, 1, 0}, {0, 0.5, 0}, 0.05);
  ASSERT_EQ(manifold.points.size(), 2u);
  for (const Manifold::Point& point : manifold.points) {
    EXPECT_NEAR(std::abs(point.place.x()), 1, 1e-12);
    EXPECT_NEAR(point.gap, -0.01, 1e-12);
  }
}

TEST(Manifold, OfEdgesThatCrossIsThePointBetweenThem) {
  const Eigen::Matrix3d on_edge = Eigen::AngleAxisd(kHalfTurn / 4, Vec3::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d across = Eigen::AngleAxisd(kHalfTurn / 4, Vec3::UnitZ()).toRotationMatrix();
  const double height = std::sqrt(0.02);  // of an edge over the axis
  const PlacedShape a{Box{{1, 0.1, 0.1}}, {0, 2 * height - 0.01, 0}, on_edge},
      b{Box{{0.1, 0.1, 1}}, {0, 0, 0}, across};
  const Manifold manifold = manifold_of(a, b, {0, 1, 0}, {0, height, 0}, 0.05);
  ASSERT_EQ(manifold.points.size(), 1u);
  EXPECT_EQ(manifold.points[0].place, Vec3(0, height, 0));
  EXPECT_NEAR(manifold.points[0].gap, -0.01, 1e-12);
}

// --- Which contacts, in which order ---

TEST(BodyCollision, LooksAtNoPairThatNothingMovesAndAtNoneThatIsApart) {
  BodyCollision collision;
  const std::vector<Solid> solids{solid_of(Box{{1, 1, 1}}, {0, 0, 0}, 0),
                                  solid_of(Box{{1, 1, 1}}, {1, 0, 0}, 0), solid_of(Sphere{0.1}, {0, 1.3, 0}),
                                  solid_of(Sphere{0.1}, {0, 1.05, 0.5})};
  const std::vector<BodyContact>& contacts = collision.find(solids, 1.0 / 60);
  ASSERT_EQ(contacts.size(), 2u);  // of the lower ball and the two boxes
  EXPECT_EQ(contacts[0].b, 3);
  EXPECT_EQ(contacts[1].b, 3);
  EXPECT_NEAR(contacts[0].gap, -0.05, 1e-15);
  EXPECT_LT((contacts[0].normal - Vec3(0, -1, 0)).norm(), 1e-15);  // from the ball to the box
}

TEST(BodyCollision, OrdersWhatYieldsFirstAndWhatStandsLastWhateverTheTreesOrder) {
  std::vector<Solid> solids;
  for (int i = 0; i < 6; ++i)
    solids.push_back(solid_of(Box{{0.5, 0.5, 0.5}}, {0.95 * i, 0, 0}, i == 3 ? 0 : 1));
  solids.push_back(solid_of(HalfSpace{}, {0, -0.5, 0}, 0));
  solids[3].mobile = true;
  BodyCollision collision;
  const auto pairs = [&] {
    std::vector<std::pair<int, int>> found;
    for (const BodyContact& c : collision.find(solids, 1.0 / 60)) {
      if (found.empty() || found.back() != std::make_pair(c.a, c.b)) found.emplace_back(c.a, c.b);
    }
    return found;
  };
  const std::vector<std::pair<int, int>> expected{{0, 1}, {1, 2}, {4, 5}, {2, 3}, {3, 4},
                                                  {0, 6}, {1, 6}, {2, 6}, {4, 6}, {5, 6}};
  EXPECT_EQ(pairs(), expected);
  // A tree with a history: away and back again.
  for (Solid& solid : solids) solid.start.x() = solid.position.x() = -7 * solid.position.x();
  collision.find(solids, 1.0 / 60);
  for (Solid& solid : solids) solid.start.x() = solid.position.x() = solid.position.x() / -7;
  EXPECT_EQ(pairs(), expected);
}

TEST(BodyCollision, KeepsEightPointsOfMany) {
  const TriangleMesh disc(test::revolved(2, 64, false, [](double u, double v) {
    const double round = 2 * kHalfTurn * v;
    if (u == 0 || u == 1) return Vec3(0, u == 0 ? 0.2 : -0.2, 0);
    return Vec3(std::cos(round), -0.2, std::sin(round));
  }));
  BodyCollision collision;
  const std::vector<BodyContact>& contacts =
      collision.find({solid_of(Mesh{&disc}, {0, 0.2, 0}), solid_of(HalfSpace{}, {0, 0, 0}, 0)}, 1.0 / 60);
  ASSERT_EQ(contacts.size(), 8u);  // of 65 on the floor
  Eigen::AlignedBox3d box;
  for (const BodyContact& contact : contacts) box.extend(contact.arm_a);
  EXPECT_GT(box.sizes().x(), 1.8);  // far apart
  EXPECT_GT(box.sizes().z(), 1.8);
}

TEST(BodyCollision, FindsNothingWhereSomethingIsNowhere) {
  BodyCollision collision;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      collision.find({solid_of(Sphere{1}, {nan, 0, 0}), solid_of(Sphere{1}, {0, 0, 0})}, 1.0 / 60).empty());
}

// --- In a simulation ---

/// A sheet that lies on the floor, and over it a ball and two bodies.
SimulationDescription falling_scene() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1.5, 1.5};
  cloth.position = {0, 0.002, 0};
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-kHalfTurn / 2, Vec3::UnitX()));
  cloth.min_level = cloth.initial_level = cloth.max_level = 4;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.balls = {flying_ball({0.05, 1, 0}, 0.2, {0, 0, 0}, 0.3)};
  scene.obstacles = {ground(0.5), flying(BoxDescription{{0.3, 0.2, 0.3}}, {-0.1, 0.5, 0.1}, {0, 0, 0}, 0.3),
                     flying(CapsuleDescription{0.08, 0.4}, {0.3, 0.7, -0.3}, {0, 0, 0}, 0.3)};
  return scene;
}

TEST(BodyContact, BodiesThatFallOnAClothOnTheFloorStayOverBoth) {
  Simulation<float> simulation(falling_scene());
  double deepest = 0;
  for (int step = 0; step < 240; ++step) {
    simulation.step();
    const Colliders& colliders = simulation.colliders();
    deepest = std::min(deepest, colliders.balls()[0].position.y() - 0.2);
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
      const Obstacle& body = colliders.obstacles()[i];
      deepest = std::min(deepest, body.solid.placed(1).bounds().min().y());
    }
  }
  EXPECT_GT(deepest, -2e-3);
  EXPECT_TRUE(simulation.healthy());
  test::each_node(simulation.cloths()[0].particles().grid(), [&](int r, int c) {
    ASSERT_GT(simulation.cloths()[0].particles().position_at(r, c).y(), -1e-4);
  });
}

TEST(BodyContact, WhatAClothPressesOntoTheFloorStaysOutsideOfIt) {
  // A sheet of 6 kg falls on a ball of 0.2 kg that lies on the floor.
  SimulationDescription scene = falling_scene();
  scene.obstacles.resize(1);
  scene.cloths[0].position = {0, 0.5, 0};
  scene.cloths[0].material.density = 2.7;
  scene.balls = {flying_ball({0, 0.2, 0}, 0.2)};
  scene.balls[0].mass = 0.2;
  Simulation<float> simulation(scene);
  bool touched = false;
  for (int step = 0; step < 120; ++step) {
    simulation.step();
    touched = touched || simulation.last_advance(0).nodes_in_contact > 0;
    ASSERT_GT(simulation.colliders().balls()[0].position.y(), 0.2 - 1e-4) << step;
  }
  EXPECT_TRUE(touched);
}

TEST(BodyContact, AResetAndASecondSimulationGiveTheSameBits) {
  Simulation<float> first(falling_scene()), second(falling_scene());
  run(first, 120);
  run(second, 120);
  const std::uint64_t hash = state_hash(first);
  EXPECT_EQ(state_hash(second), hash);
  first.reset();
  run(first, 120);
  EXPECT_EQ(state_hash(first), hash);
}

TEST(BodyContact, ABallThrownByACommandRollsAndOneThatIsHeldDoesNot) {
  SimulationDescription scene = falling_scene();
  scene.obstacles.resize(1);
  scene.cloths[0].position = {0, 5, 0};
  scene.balls[0].position = {5, 0.2, 0};
  scene.balls[0].motion = BallDescription::Motion::kinematic;
  Simulation<float> simulation(scene);
  run(simulation, 10);
  EXPECT_EQ(simulation.colliders().balls()[0].position, Vec3(5, 0.2, 0));
  ASSERT_TRUE(simulation.throw_ball(1, {3, 0, 0}));
  run(simulation, 120);
  EXPECT_NEAR(simulation.colliders().balls()[0].velocity.x(), 3 * 5.0 / 7, 1e-6);  // as in the truths
  ASSERT_TRUE(simulation.move_ball(1, {5, 0.2, 0}));
  EXPECT_EQ(simulation.colliders().balls()[0].spin, Vec3(0, 0, 0));
}

TEST(BodyContact, APressThatLeavesABoxNoRoomOverlapsItAndDoesNotDriveItIntoTheGround) {
  // A box of 0.2 m on the ground, a press that comes down over it in a second, stays for one and goes. No
  // state is right where it leaves less than 0.2 m: the ground, which never moves, is kept, the press is
  // inside the box. No speed is left of it, and none comes of it when the press goes.
  for (const double room : {0.201, 0.199, 0.15, 0.02}) {
    SCOPED_TRACE(room);
    ObstacleDescription press = standing(BoxDescription{{1, 0.2, 1}}, {0, 0.5, 0}, 0.5);
    const auto height = [](double y) { return Pose{{0, y, 0}, Quaternion::Identity()}; };
    press.path = {{0, height(0.5)}, {1, height(room + 0.1)}, {2, height(room + 0.1)}, {3, height(0.5)}};
    test::Bodies bodies(
        {}, {ground(0.5), press, flying(BoxDescription{{0.2, 0.2, 0.2}}, {0.05, 0.1, 0.03}, {0, 0, 0}, 0.5)});
    const Obstacle& box = bodies.obstacle(2);
    for (int step = 0; step < 240; ++step) {
      bodies.step();
      ASSERT_GT(box.solid.placed(1).bounds().min().y(), -1e-4) << "step " << step;
      // Driven by the press it goes no faster than that, 0.4 m/s; let go it stays.
      ASSERT_LT(box.body->velocity().norm(), step < 61 ? 0.4 : 1e-3) << "step " << step;
    }
    EXPECT_NEAR(box.pose.position.y(), 0.1, 1e-6);
  }
}

TEST(BodyContact, AnObstacleThatMovesTakesABodyAlong) {
  // A wall that goes at 1 m/s along its path pushes a box before it.
  ObstacleDescription wall = standing(BoxDescription{{0.2, 2, 2}}, {0, 0, 0});
  wall.path = {{0, {{0, 1, 0}, Quaternion::Identity()}}, {2, {{2, 1, 0}, Quaternion::Identity()}}};
  test::Bodies bodies({flying_ball({0.8, 0.2, 0.5}, 0.2)},
                      {ground(), wall, flying(BoxDescription{{0.4, 0.4, 0.4}}, {0.5, 0.2, 0})});
  bodies.run(1.9);
  EXPECT_NEAR(bodies.obstacle(2).pose.position.x(), 1.9 + 0.1 + 0.2, 1e-6);
  EXPECT_NEAR(bodies.obstacle(2).body->velocity().x(), 1, 1e-6);
  EXPECT_NEAR(bodies.ball(0).position.x(), 1.9 + 0.1 + 0.2, 1e-6);
}

}  // namespace
}  // namespace weft
