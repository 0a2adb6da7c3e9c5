// How balls move: told, along a path, thrown.
#include "cloth/world/colliders.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

constexpr double kDt = 1.0 / 64.0;  // exact in binary, so that straight motion is too

BallDescription resting_ball(const Vec3& position) {
  BallDescription ball;
  ball.position = position;
  ball.radius = 0.25;
  return ball;
}

TEST(Colliders, IdsCountUpFromOneAndAreNotUsedAgain) {
  Colliders colliders({resting_ball({0, 0, 0}), resting_ball({1, 0, 0})});
  ASSERT_EQ(colliders.balls().size(), 2u);
  EXPECT_EQ(colliders.balls()[0].id, 1u);
  EXPECT_EQ(colliders.balls()[1].id, 2u);
  EXPECT_EQ(colliders.add(resting_ball({2, 0, 0})), 3u);
  EXPECT_TRUE(colliders.remove(3));
  EXPECT_TRUE(colliders.remove(1));
  EXPECT_EQ(colliders.add(resting_ball({3, 0, 0})), 4u);
  EXPECT_EQ(colliders.find(1), nullptr);
  ASSERT_NE(colliders.find(4), nullptr);
  EXPECT_EQ(colliders.find(4)->position, Vec3(3, 0, 0));
}

TEST(Colliders, CommandsToAnUnknownBallAreRefused) {
  Colliders colliders({resting_ball({0, 0, 0})});
  EXPECT_FALSE(colliders.move(7, {1, 1, 1}));
  EXPECT_FALSE(colliders.throw_ball(7, {1, 1, 1}));
  EXPECT_FALSE(colliders.remove(7));
  EXPECT_EQ(colliders.balls().size(), 1u);
}

TEST(Colliders, AKinematicBallKeepsItsVelocityAndIgnoresGravity) {
  BallDescription description = resting_ball({1, 2, 3});
  description.velocity = {4, 0, -8};
  Colliders colliders({description});
  colliders.begin_step(0.0, kDt, {0, -9.81, 0});
  const Ball& ball = colliders.balls()[0];
  EXPECT_EQ(ball.start, Vec3(1, 2, 3));
  EXPECT_EQ(ball.position, Vec3(1.0625, 2, 2.875));
  EXPECT_EQ(ball.velocity, Vec3(4, 0, -8));
  EXPECT_EQ(ball.solid().at(0.5), Vec3(1.03125, 2, 2.9375));  // a straight line during the step
}

TEST(Colliders, MoveGoesThereWithinTheNextStepAndStays) {
  BallDescription description = resting_ball({0, 0, 0});
  description.velocity = {5, 0, 0};
  Colliders colliders({description});
  EXPECT_TRUE(colliders.move(1, {0.5, 0.25, 0}));
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0, 0, 0));  // not before the step
  colliders.begin_step(0.0, kDt, {0, -9.81, 0});
  EXPECT_EQ(colliders.balls()[0].start, Vec3(0, 0, 0));
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0.5, 0.25, 0));
  EXPECT_EQ(colliders.balls()[0].velocity, Vec3(32, 16, 0));  // what the cloth feels: 0.5 m in 1/64 s
  colliders.end_step();
  colliders.begin_step(kDt, kDt, {0, -9.81, 0});
  EXPECT_EQ(colliders.balls()[0].start, Vec3(0.5, 0.25, 0));
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0.5, 0.25, 0));
  EXPECT_EQ(colliders.balls()[0].velocity, Vec3(0, 0, 0));
}

TEST(Colliders, TheLastOfSeveralMovesBeforeAStepCounts) {
  Colliders colliders({resting_ball({0, 0, 0})});
  colliders.move(1, {9, 9, 9});
  colliders.move(1, {1, 0, 0});
  colliders.begin_step(0.0, kDt, {0, 0, 0});
  EXPECT_EQ(colliders.balls()[0].position, Vec3(1, 0, 0));
}

TEST(Colliders, AThrownBallFallsLikeEquation6) {
  // v += g dt, then r += v dt with the new v: after n steps y = v0 n dt - g dt^2 n (n+1) / 2. 64 steps of
  // 1/64 s from 3 m/s: 3 - 9.81 * 65 / 128 = -1.981640625.
  Colliders colliders({resting_ball({0, 0, 0})});
  EXPECT_TRUE(colliders.throw_ball(1, {1, 3, 0}));
  EXPECT_EQ(colliders.balls()[0].motion, BallDescription::Motion::dynamic);
  for (int step = 0; step < 64; ++step) {
    colliders.begin_step(step * kDt, kDt, {0, -9.81, 0});
    const Ball& ball = colliders.balls()[0];
    EXPECT_LT((ball.velocity - (ball.position - ball.start) / kDt).norm(), 1e-12);
    colliders.end_step();
  }
  EXPECT_NEAR(colliders.balls()[0].position.x(), 1.0, 1e-12);
  EXPECT_NEAR(colliders.balls()[0].position.y(), -1.981640625, 1e-12);
}

TEST(Colliders, ADynamicBallTakesUpItsImpulse) {
  // 0.5 N s on 2 kg: 0.25 m/s; once. And where it was pushed to.
  BallDescription description = resting_ball({0, 0, 0});
  description.motion = BallDescription::Motion::dynamic;
  description.mass = 2;
  description.velocity = {1, 0, 0};
  Colliders colliders({description});
  colliders.begin_step(0.0, kDt, {0, 0, 0});
  std::vector<Solid> left = colliders.solids();
  left[0].go_on({1, 0, 0.25 * left[0].inverse_mass}, {0, 0, 0}, 0.5, kDt);
  colliders.push(colliders.solids(), left);
  colliders.push(colliders.solids(), left);                // another cloth
  colliders.push(colliders.solids(), colliders.solids());  // one that does not touch it
  colliders.end_step();
  EXPECT_EQ(colliders.balls()[0].position, Vec3(kDt, 0, 0.25 * kDt / 2));
  EXPECT_EQ(colliders.solids()[0].position, colliders.balls()[0].position);
  for (int step = 1; step <= 2; ++step) {
    colliders.begin_step(step * kDt, kDt, {0, 0, 0});
    EXPECT_EQ(colliders.balls()[0].velocity, Vec3(1, 0, 0.25));
    colliders.end_step();
  }
}

TEST(Colliders, ClothsThatTouchABallShareItsMass) {
  // 2 kg at 1 m/s that two cloths each bring to rest, as 1 kg each: together they take 2 N s, and it stops.
  BallDescription description = resting_ball({0, 0, 0});
  description.motion = BallDescription::Motion::dynamic;
  description.mass = 2;
  description.velocity = {1, 0, 0};
  Colliders colliders({description});
  colliders.begin_step(0, kDt, {0, 0, 0});
  EXPECT_EQ(colliders.solids()[0].inverse_mass, 1 / 2.0);
  colliders.share(1, 2);
  EXPECT_EQ(colliders.solids()[0].inverse_mass, 2 / 2.0);
  std::vector<Solid> left = colliders.solids();
  left[0].go_on({0, 0, 0}, {0, 0, 0}, 0, kDt);
  for (int cloth = 0; cloth < 2; ++cloth) colliders.push(colliders.solids(), left);
  colliders.end_step();
  EXPECT_EQ(colliders.balls()[0].velocity, Vec3(0, 0, 0));
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0, 0, 0));
  colliders.begin_step(kDt, kDt, {0, 0, 0});
  EXPECT_EQ(colliders.solids()[0].inverse_mass, 1 / 2.0);
}

TEST(Colliders, AKinematicBallDoesNotYield) {
  Colliders colliders({resting_ball({0, 0, 0})});
  colliders.begin_step(0.0, kDt, {0, 0, 0});
  EXPECT_FALSE(colliders.solids()[0].yields());
}

TEST(Colliders, APathIsLinearBetweenItsPointsAndRestsOutside) {
  BallDescription description = resting_ball({99, 99, 99});  // overridden by the path
  description.velocity = {7, 7, 7};
  description.path = {{1.0, {0, 0, 0}}, {2.0, {4, 0, 0}}, {4.0, {4, 8, 0}}};
  Colliders colliders({description});
  const auto at_end_of = [&](double time) {
    colliders.begin_step(time - 0.5, 0.5, {0, -9.81, 0});
    colliders.end_step();
    return colliders.balls()[0];
  };
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0, 0, 0));
  EXPECT_EQ(at_end_of(0.5).position, Vec3(0, 0, 0));
  EXPECT_EQ(at_end_of(1.0).velocity, Vec3(0, 0, 0));
  EXPECT_EQ(at_end_of(1.5).position, Vec3(2, 0, 0));
  EXPECT_EQ(at_end_of(2.0).velocity, Vec3(4, 0, 0));
  EXPECT_EQ(at_end_of(2.5).position, Vec3(4, 2, 0));
  EXPECT_EQ(at_end_of(3.0).velocity, Vec3(0, 4, 0));
  EXPECT_EQ(at_end_of(3.5).position, Vec3(4, 6, 0));
  EXPECT_EQ(at_end_of(4.0).position, Vec3(4, 8, 0));
  EXPECT_EQ(at_end_of(4.5).position, Vec3(4, 8, 0));
  EXPECT_EQ(at_end_of(5.0).velocity, Vec3(0, 0, 0));
}

TEST(Colliders, ACommandTakesABallOffItsPath) {
  BallDescription description = resting_ball({0, 0, 0});
  description.path = {{0.0, {0, 0, 0}}, {10.0, {10, 0, 0}}};
  Colliders colliders({description, description});
  colliders.move(1, {0, 5, 0});
  colliders.throw_ball(2, {0, 0, 64});
  for (int step = 0; step < 3; ++step) {
    colliders.begin_step(step * kDt, kDt, {0, 0, 0});
    colliders.end_step();
  }
  EXPECT_EQ(colliders.balls()[0].position, Vec3(0, 5, 0));
  EXPECT_EQ(colliders.balls()[1].position, Vec3(0, 0, 3));
}

// In a step that is made in parts it goes at one speed, 4 m in a step.
TEST(Colliders, AMovedBallGetsThereWithTheStepsLastPart) {
  Colliders colliders({resting_ball({0, 0, 0})});
  colliders.move(1, {4, 0, 0});
  for (int part = 0; part < 4; ++part) {
    colliders.begin_step(part * kDt / 4, kDt / 4, {0, 0, 0}, {}, 4 - part);
    EXPECT_EQ(colliders.balls()[0].position, Vec3(part + 1, 0, 0));
    EXPECT_EQ(colliders.balls()[0].velocity, Vec3(4 / kDt, 0, 0));
    colliders.end_step();
  }
  colliders.begin_step(kDt, kDt / 4, {0, 0, 0}, {}, 4);
  EXPECT_EQ(colliders.balls()[0].position, Vec3(4, 0, 0));
  EXPECT_EQ(colliders.balls()[0].velocity, Vec3(0, 0, 0));
}

TEST(Colliders, ADynamicBallThatIsMovedIsHeldThere) {
  Colliders colliders({resting_ball({0, 0, 0})});
  colliders.throw_ball(1, {1, 1, 1});
  colliders.move(1, {2, 2, 2});
  for (int step = 0; step < 3; ++step) {
    colliders.begin_step(step * kDt, kDt, {0, -9.81, 0});
    colliders.end_step();
  }
  EXPECT_EQ(colliders.balls()[0].motion, BallDescription::Motion::kinematic);
  EXPECT_EQ(colliders.balls()[0].position, Vec3(2, 2, 2));
}

}  // namespace
}  // namespace weft
