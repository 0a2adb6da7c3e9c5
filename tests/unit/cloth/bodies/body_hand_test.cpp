// A hand on a body: where it holds it, how fast it gets there, its most force, and the bits.
#include "cloth/bodies/body_hand.h"

#include <gtest/gtest.h>

#include <limits>

#include "busy_scene.h"
#include "cloth/world/state_hash.h"

namespace weft {
namespace {

using test::run;

constexpr double kStep = 1.0 / 60;

ObstacleDescription box_of(double mass, bool dynamic = true) {
  ObstacleDescription box;
  box.shape = BoxDescription{.size = {0.2, 0.4, 0.6}};
  box.body = BodyDescription{.mass = mass, .dynamic = dynamic};
  return box;
}

void step(Colliders& colliders, int count, const Vec3& gravity = standard_gravity()) {
  for (int i = 0; i < count; ++i) {
    colliders.begin_step(0, kStep, gravity);
    colliders.end_step();
  }
}

TEST(BodyHand, HoldsBodiesOfAnyMassJustBelowItself) {
  // Where the spring bears the weight: g / frequency^2.
  for (const double mass : {0.01, 1.0, 500.0}) {
    Colliders colliders({}, {box_of(mass)});
    ASSERT_TRUE(colliders.grab({1, 0, {0, 0, 0}, {0, 2, 0}, 1e4}));
    step(colliders, 120);
    EXPECT_NEAR(colliders.obstacles()[0].pose.position.y(), 2 - 9.81 / 900, 1e-9);
    EXPECT_LT(colliders.obstacles()[0].body->velocity().norm(), 1e-9);
  }
}

TEST(BodyHand, IsTheCriticallyDampedSpringWhenStepsAreShort) {
  // From rest at the distance d: the spring leaves d (1 + w t) exp(-w t) of it after t.
  constexpr double kDistance = 0.1, kTime = 0.05, kShort = 1e-5;
  Colliders colliders({}, {box_of(2)});
  colliders.grab({1, 0, {0, 0, 0}, {kDistance, 0, 0}, 1e4});
  for (int i = 0; i < std::lround(kTime / kShort); ++i) colliders.begin_step(0, kShort, {0, 0, 0});
  const double swung = kHandFrequency * kTime;
  EXPECT_NEAR(kDistance - colliders.obstacles()[0].pose.position.x(),
              kDistance * (1 + swung) * std::exp(-swung),
              kDistance * kHandFrequency * kShort);  // first order
}

TEST(BodyHand, PullsWithAtMostItsForce) {
  // 3 N on 2 kg, far away: 1.5 m/s2, in equal steps from rest.
  Colliders colliders({}, {box_of(2)});
  colliders.grab({1, 0, {0, 0, 0}, {100, 0, 0}, 3});
  step(colliders, 30, {0, 0, 0});
  EXPECT_NEAR(colliders.obstacles()[0].body->velocity().x(), 1.5 * 0.5, 1e-12);
  // Less than its weight does not lift it.
  Colliders heavy({}, {box_of(2)});
  heavy.grab({1, 0, {0, 0, 0}, {0, 100, 0}, 3});
  step(heavy, 30);
  EXPECT_NEAR(heavy.obstacles()[0].body->velocity().y(), (3.0 / 2 - 9.81) * 0.5, 1e-12);
}

TEST(BodyHand, TheBodyHangsFromWhereItIsHeldAndTurnsNoMore) {
  const Vec3 corner(0.1, 0.2, 0.3);
  Colliders colliders({}, {box_of(2)});
  colliders.throw_obstacle(0, {0, 0, 0}, {0, 15, 0});
  colliders.grab({1, 0, corner, {1, 1, 1}, 1000});
  step(colliders, 1200);
  const Obstacle& box = colliders.obstacles()[0];
  const Vec3 held = box.pose.position + box.pose.orientation * corner;
  EXPECT_LT((held - Vec3(1, 1 - 9.81 / 900, 1)).norm(), 1e-6);
  // Its centre straight below that, and at rest.
  EXPECT_LT((box.pose.position - held - Vec3(0, -corner.norm(), 0)).norm(), 1e-6);
  EXPECT_LT(box.body->spin(box.pose.orientation).norm(), 1e-6);
}

TEST(BodyHand, AWeakGripHardlyTakesItsSpin) {
  // At most force x arm x time of angular momentum: 0.001 N, 0.1 m, 1 s.
  Colliders colliders({}, {box_of(2)});
  colliders.throw_obstacle(0, {0, 0, 0}, {0, 15, 0});
  const Vec3 before = colliders.obstacles()[0].body->angular_momentum();
  colliders.grab({1, 0, {0, 0, 0}, {0, 0, 0}, 1e-3});
  step(colliders, 60, {0, 0, 0});
  EXPECT_NEAR((before - colliders.obstacles()[0].body->angular_momentum()).norm(), 1e-4, 1e-12);
}

TEST(BodyHand, TakesABodyOffItsPathAtItsSpeedAndLetsGo) {
  ObstacleDescription cart = box_of(2, false);
  cart.path = {{0, {{0, 0, 0}, Quaternion::Identity()}},
               {10, {{20, 0, 0}, Quaternion::Identity()}}};  // 2 m/s
  Colliders colliders({}, {cart});
  colliders.begin_step(0, kStep, {0, 0, 0});
  const double x = colliders.obstacles()[0].pose.position.x();
  ASSERT_TRUE(colliders.grab({7, 0, {0, 0, 0}, {x, 0, 0}, 1e-3}));
  EXPECT_TRUE(colliders.release(7));
  EXPECT_FALSE(colliders.release(7));
  EXPECT_FALSE(colliders.move_grab(7, {0, 0, 0}));
  step(colliders, 60);
  EXPECT_NEAR(colliders.obstacles()[0].pose.position.x(), x + 2, 1e-9);
  EXPECT_NEAR(colliders.obstacles()[0].pose.position.y(), -9.81 * 61 / 120, 1e-9);  // semi-implicit
}

TEST(BodyHand, HoldsBodiesAlone) {
  ObstacleDescription wall = box_of(1);
  wall.body.reset();
  Colliders colliders({}, {wall});
  EXPECT_FALSE(colliders.grab({1, 0, {0, 0, 0}, {0, 0, 0}, 10}));
  EXPECT_FALSE(colliders.grab({1, 1, {0, 0, 0}, {0, 0, 0}, 10}));
  EXPECT_TRUE(colliders.hands().empty());
}

/// A box lies on the floor beside another, on which it is dragged.
SimulationDescription floor_scene() {
  SimulationDescription scene = test::hung_scene();
  ObstacleDescription floor, first = box_of(2), second = box_of(2);
  floor.shape = PlaneDescription{};
  floor.position = {0, -3, 0};
  first.position = {0, -2.8, 0};
  second.position = {0.5, -2.8, 0};
  scene.obstacles = {floor, first, second};
  return scene;
}

TEST(BodyHand, ThatIsBelowTheFloorLeavesTheBodyOnIt) {
  Simulation<float> simulation(floor_scene());
  simulation.grab_obstacle(1, {0, 0, 0}, Vec3(0, -10, 0), 100);
  run(simulation, 120);
  // 0.2 m above it, but for what a step's overlap of 100 N and its weight leaves.
  EXPECT_NEAR(simulation.colliders().obstacles()[1].pose.position.y(), -2.8, 1e-3);
}

TEST(BodyHand, DragsABodyAlongThatShovesAnother) {
  Simulation<float> simulation(floor_scene());
  const auto grab = simulation.grab_obstacle(1, {0, 0, 0}, {}, 200);
  ASSERT_TRUE(grab);
  run(simulation, 30);
  simulation.move_grab(*grab, {0.6, -2.8, 0});
  run(simulation, 120);
  const auto& obstacles = simulation.colliders().obstacles();
  // One edge length, 0.2 m, apart, and not into each other.
  EXPECT_GT(obstacles[2].pose.position.x(), 0.7);
  EXPECT_GT(obstacles[2].pose.position.x() - obstacles[1].pose.position.x(), 0.199);
}

TEST(BodyHand, TheSameCommandsGiveTheSameBits) {
  const auto hash = [](double to) {
    Simulation<float> simulation(floor_scene());
    const auto grab = simulation.grab_obstacle(1, {0.1, 0.2, 0}, {}, 50);
    run(simulation, 10);
    simulation.move_grab(*grab, {to, -2, 0});
    run(simulation, 30);
    simulation.release(*grab);
    run(simulation, 30);
    return state_hash(simulation);
  };
  EXPECT_EQ(hash(0.3), hash(0.3));
  EXPECT_NE(hash(0.3), hash(0.3000001));
  // A reset lets go: what follows is what follows without a hand.
  Simulation<float> held(floor_scene()), free(floor_scene());
  held.grab_obstacle(1, {0, 0, 0}, Vec3(0, 0, 0), 50);
  run(held, 10);
  held.reset();
  run(held, 10);
  run(free, 10);
  EXPECT_EQ(state_hash(held), state_hash(free));
}

}  // namespace
}  // namespace weft
