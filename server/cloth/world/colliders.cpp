#include "cloth/world/colliders.h"

#include <algorithm>

#include "cloth/core/path.h"

namespace weft {
namespace {

template <class Description>
Quaternion turned(const Description& description) {
  return description.orientation;
}
Quaternion turned(const PlaneDescription& plane) { return turn_from_y(plane.normal); }

Obstacle made_of(const ObstacleDescription& description, std::size_t index) {
  Obstacle obstacle;
  obstacle.pose.position = description.position;
  Shape& shape = obstacle.solid.shape;
  shape = std::visit([](const auto& own) { return own.shape(); }, description.shape);
  obstacle.pose.orientation = std::visit([](const auto& own) { return turned(own); }, description.shape);
  if (const auto* mesh = std::get_if<MeshDescription>(&description.shape)) obstacle.surface = mesh->surface;
  obstacle.path = description.path;
  obstacle.loops = description.loop;
  obstacle.mobile = !description.path.empty();
  Solid& solid = obstacle.solid;
  solid.id = kFirstObstacle + static_cast<ColliderId>(index);
  solid.friction = description.friction;
  solid.rotation = obstacle.pose.orientation.toRotationMatrix();
  if (obstacle.mobile) obstacle.take(along_path(obstacle.path, 0, obstacle.loops));
  solid.start = solid.position = obstacle.pose.position;
  if (description.body) {
    obstacle.body.emplace(*description.body, shape, obstacle.pose);
    obstacle.mobile = obstacle.mobile || obstacle.flies();
  }
  return obstacle;
}

template <class Balls>
auto find_ball(Balls& balls, BallId id) {
  return std::find_if(balls.begin(), balls.end(), [&](const Ball& ball) { return ball.id == id; });
}

}  // namespace

Solid Ball::solid() const {
  return {.id = id,
          .shape = Sphere{radius},
          .friction = friction,
          .inverse_mass = awake() ? 1 / mass : 0,
          .just_put = just_put,
          .mobile = true,
          .start = start,
          .position = position,
          .velocity = velocity};
}

void Obstacle::take(const Pose& place) {
  pose.position = solid.position = place.position;
  if (std::holds_alternative<HalfSpace>(solid.shape)) return;
  pose.orientation = place.orientation;
  solid.rotation = place.orientation.toRotationMatrix();
}

Colliders::Colliders(const std::vector<BallDescription>& balls,
                     const std::vector<ObstacleDescription>& obstacles, double sleep_speed)
    : sleep_speed_(sleep_speed) {
  for (const BallDescription& ball : balls) add(ball);
  for (const ObstacleDescription& obstacle : obstacles)
    obstacles_.push_back(made_of(obstacle, obstacles_.size()));
}

const Ball* Colliders::find(BallId id) const {
  const auto found = find_ball(balls_, id);
  return found == balls_.end() ? nullptr : &*found;
}

BallId Colliders::add(const BallDescription& description) {
  Ball ball;
  ball.id = next_id_++;
  ball.motion = description.motion;
  ball.radius = description.radius;
  ball.mass = description.mass;
  ball.friction = description.friction;
  ball.path = description.path;
  ball.loops = description.loop;
  ball.position = description.path.empty() ? description.position : description.path.front().position;
  ball.start = ball.position;
  if (description.path.empty()) ball.velocity = description.velocity;
  balls_.push_back(std::move(ball));
  return balls_.back().id;
}

bool Colliders::move(BallId id, const Vec3& target) {
  const auto ball = find_ball(balls_, id);
  if (ball == balls_.end()) return false;
  ball->motion = BallDescription::Motion::kinematic;
  ball->rest.wake();
  ball->spin.setZero();
  ball->path.clear();
  forget_target(id);
  targets_.push_back({id, target, false});
  return true;
}

bool Colliders::throw_ball(BallId id, const Vec3& velocity) {
  const auto ball = find_ball(balls_, id);
  if (ball == balls_.end()) return false;
  ball->motion = BallDescription::Motion::dynamic;
  ball->rest.wake();
  ball->path.clear();
  ball->velocity = velocity;
  forget_target(id);
  return true;
}

bool Colliders::remove(BallId id) {
  const auto ball = find_ball(balls_, id);
  if (ball == balls_.end()) return false;
  wake_near(ball->solid());
  balls_.erase(ball);
  forget_target(id);
  return true;
}

bool Colliders::set_friction(BallId id, double friction) {
  const auto ball = find_ball(balls_, id);
  if (ball == balls_.end()) return false;
  ball->friction = friction;
  wake();
  return true;
}

bool Colliders::set_obstacle_friction(std::size_t index, double friction) {
  if (index >= obstacles_.size()) return false;
  obstacles_[index].solid.friction = friction;
  wake();
  return true;
}

bool Colliders::move_obstacle(std::size_t index, const Pose& target) {
  if (index >= obstacles_.size()) return false;
  Obstacle& obstacle = obstacles_[index];
  obstacle.mobile = true;
  obstacle.path.clear();
  obstacle.target = {target.position, target.orientation.normalized()};
  obstacle.rest.wake();
  if (obstacle.body) obstacle.body->hold();
  return true;
}

bool Colliders::throw_obstacle(std::size_t index, const Vec3& velocity, const Vec3& spin) {
  if (index >= obstacles_.size() || !obstacles_[index].body) return false;
  Obstacle& obstacle = obstacles_[index];
  obstacle.mobile = true;
  obstacle.path.clear();
  obstacle.target.reset();
  obstacle.rest.wake();
  obstacle.body->fling(velocity, spin, obstacle.pose.orientation);
  return true;
}

bool Colliders::grab(const BodyHand& hand) {
  if (hand.obstacle >= obstacles_.size() || !obstacles_[hand.obstacle].body) return false;
  const Obstacle& held = obstacles_[hand.obstacle];
  if (!held.flies()) throw_obstacle(hand.obstacle, held.solid.velocity, held.solid.spin);
  hands_.push_back(hand);
  return true;
}

bool Colliders::move_grab(GrabId id, const Vec3& hand) {
  const auto found =
      std::find_if(hands_.begin(), hands_.end(), [&](const BodyHand& h) { return h.id == id; });
  if (found == hands_.end()) return false;
  found->hand = hand;
  return true;
}

bool Colliders::release(GrabId id) {
  return std::erase_if(hands_, [&](const BodyHand& hand) { return hand.id == id; }) > 0;
}

void Colliders::forget_target(BallId id) {
  std::erase_if(targets_, [&](const Target& target) { return target.ball == id; });
}

void Colliders::gather_solids() {
  solids_.clear();
  for (const Ball& ball : balls_) solids_.push_back(ball.solid());
  for (const Obstacle& obstacle : obstacles_) {
    solids_.push_back(obstacle.solid);
    solids_.back().mobile = obstacle.mobile;
  }
}

}  // namespace weft
