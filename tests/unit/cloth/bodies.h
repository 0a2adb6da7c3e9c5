#pragma once
/// Balls and obstacles among themselves, without a cloth, for the tests of how they meet.
#include <vector>

#include "cloth/world/colliders.h"

namespace weft::test {

/// Stepped at 60 Hz under standard gravity.
class Bodies {
 public:
  Bodies(const std::vector<BallDescription>& balls, const std::vector<ObstacleDescription>& obstacles)
      : colliders_(balls, obstacles) {}

  Vec3 gravity = standard_gravity();
  double dt = 1.0 / 60;

  void step() {
    colliders_.begin_step(time_, dt, gravity);
    if (colliders_.may_meet()) colliders_.meet(collision_, dt);
    colliders_.end_step();
    time_ += dt;
  }
  void run(double seconds) {
    for (const double end = time_ + seconds - dt / 2; time_ < end;) step();
  }
  Colliders& colliders() { return colliders_; }
  const Ball& ball(std::size_t i) const { return colliders_.balls()[i]; }
  const Obstacle& obstacle(std::size_t i) const { return colliders_.obstacles()[i]; }

  /// Kinetic and in gravity's field, of all that flies, J.
  double energy() const {
    double sum = 0;
    for (const Ball& ball : colliders_.balls()) {
      if (ball.motion != BallDescription::Motion::dynamic) continue;
      const double inertia = 0.4 * ball.radius * ball.radius;
      sum += ball.mass * (ball.velocity.squaredNorm() / 2 + inertia * ball.spin.squaredNorm() / 2 -
                          gravity.dot(ball.position));
    }
    for (const Obstacle& obstacle : colliders_.obstacles()) {
      if (!obstacle.flies()) continue;
      const RigidBody& body = *obstacle.body;
      sum += body.mass() * (body.velocity().squaredNorm() / 2 - gravity.dot(obstacle.pose.position)) +
             body.spin(obstacle.pose.orientation).dot(body.angular_momentum()) / 2;
    }
    return sum;
  }

 private:
  Colliders colliders_;
  BodyCollision collision_;
  double time_ = 0;
};

inline BallDescription flying_ball(const Vec3& position, double radius, const Vec3& velocity = {0, 0, 0},
                                   double friction = 0) {
  BallDescription ball;
  ball.position = position;
  ball.radius = radius;
  ball.velocity = velocity;
  ball.friction = friction;
  ball.motion = BallDescription::Motion::dynamic;
  return ball;
}

/// All below y = 0, or below the plane through the origin with that normal.
inline ObstacleDescription ground(double friction = 0, const Vec3& normal = {0, 1, 0}) {
  ObstacleDescription plane;
  plane.shape = PlaneDescription{normal};
  plane.friction = friction;
  return plane;
}

template <class Shape>
ObstacleDescription standing(const Shape& shape, const Vec3& position, double friction = 0) {
  ObstacleDescription obstacle;
  obstacle.shape = shape;
  obstacle.position = position;
  obstacle.friction = friction;
  return obstacle;
}

template <class Shape>
ObstacleDescription flying(const Shape& shape, const Vec3& position, const Vec3& velocity = {0, 0, 0},
                           double friction = 0, double mass = 1) {
  ObstacleDescription obstacle = standing(shape, position, friction);
  obstacle.body = BodyDescription{mass, true, velocity, {0, 0, 0}};
  return obstacle;
}

}  // namespace weft::test
