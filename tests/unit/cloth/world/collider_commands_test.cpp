#include "cloth/world/collider_commands.h"

#include <gtest/gtest.h>

#include "commanded.h"

namespace weft {
namespace {

using test::expect_does;

TEST(ColliderCommands, BallsAreAddedMovedThrownAndRemoved) {
  BallDescription ball = test::ball_at({0, 1.5, 0.2}, 0.15, {0, -1, 0});
  ball.motion = BallDescription::Motion::dynamic;
  ball.mass = 0.5;
  ball.friction = 0.2;
  expect_does(command::AddBall{ball}, [&](auto& s) { return s.add_ball(ball); });
  expect_does(command::MoveBall{1, {0.2, 0.1, 0.8}}, [](auto& s) { return s.move_ball(1, {0.2, 0.1, 0.8}); });
  expect_does(command::ThrowBall{1, {0, 2, 0}}, [](auto& s) { return s.throw_ball(1, {0, 2, 0}); });
  expect_does(command::RemoveBall{1}, [](auto& s) { return s.remove_ball(1); });
}

TEST(ColliderCommands, FrictionIsSet) {
  expect_does(command::SetBallFriction{1, 0.7}, [](auto& s) { return s.set_ball_friction(1, 0.7); });
  expect_does(command::SetObstacleFriction{0, 0.7}, [](auto& s) { return s.set_obstacle_friction(0, 0.7); });
}

TEST(ColliderCommands, ObstaclesAreMovedThrownAndGrabbed) {
  const Pose target{{0.1, -0.5, -0.4}, Quaternion(Eigen::AngleAxisd(0.3, Vec3(0, 1, 0)))};
  expect_does(command::MoveObstacle{0, target}, [&](auto& s) { return s.move_obstacle(0, target); });
  expect_does(command::ThrowObstacle{0, {0, 2, 0}, {0, 0, 3}}, [](auto& s) {
    return s.throw_obstacle(0, {0, 2, 0}, {0, 0, 3});
  });
  const Vec3 point(0.35, 0.5, -0.6), hand(0.5, 0.6, -0.6);
  expect_does(command::GrabObstacle{1, point, hand, 20},
              [&](auto& s) { return s.grab_obstacle(1, point, hand, 20); });
}

// What there is not is told, and nothing happens.
TEST(ColliderCommands, WhatThereIsNotIsLeftAlone) {
  Simulation<float> simulation(test::commanded_scene());
  test::run(simulation, 2);
  const std::string before = save_state(simulation);
  EXPECT_FALSE(command::MoveBall({9, {0, 0, 0}}).carry_out(simulation));
  EXPECT_FALSE(command::ThrowBall({9, {0, 0, 0}}).carry_out(simulation));
  EXPECT_FALSE(command::RemoveBall{9}.carry_out(simulation));
  EXPECT_FALSE((command::SetBallFriction{9, 0.1}.carry_out(simulation)));
  EXPECT_TRUE(save_state(simulation) == before);
}

}  // namespace
}  // namespace weft
