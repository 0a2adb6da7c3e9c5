// How balls and bodies at rest fall asleep with what they lie on, and wake.
#include <algorithm>

#include "cloth/world/colliders.h"

namespace weft {
namespace {

/// Around its way in the step, which it may leave by `more`, m.
Eigen::AlignedBox3d box_of(const Solid& solid, double more) {
  Eigen::AlignedBox3d box = solid.placed(1).bounds();
  const double margin = kRestMargin * box.sizes().maxCoeff() + more;
  box.extend(solid.placed(0).bounds());
  return {box.min() - Vec3::Constant(margin), box.max() + Vec3::Constant(margin)};
}

}  // namespace

bool Colliders::may_rest() const {
  const auto quiet = [](const auto& body) { return body.rest.quiet(); };
  return std::any_of(balls_.begin(), balls_.end(), quiet) ||
         std::any_of(obstacles_.begin(), obstacles_.end(), quiet);
}

void Colliders::let_sleep(double dt, const Vec3& gravity, const std::vector<Sleeper>& cloths) {
  std::vector<Sleeper> sleepers;
  std::vector<BodyRest*> rests;  // nullptr: no force moves it
  bool all_sleep =
      std::all_of(cloths.begin(), cloths.end(), [](const Sleeper& cloth) { return cloth.quiet; });
  const auto add = [&](const Solid& solid, const Vec3& velocity, BodyRest* rest) {
    const bool quiet = rest != nullptr && rest->quiet();
    all_sleep = all_sleep && quiet && rest->asleep();
    sleepers.push_back({box_of(solid, quiet ? 0 : dt * (velocity.norm() + dt * gravity.norm())), quiet});
    rests.push_back(rest);
  };
  // What stands still joins nothing and wakes nobody.
  for (Ball& ball : balls_) {
    const Solid solid = ball.solid();
    if (ball.flies() || solid.moves() || solid.just_put) {
      add(solid, solid.velocity, ball.flies() ? &ball.rest : nullptr);
    }
  }
  for (Obstacle& obstacle : obstacles_) {
    if (obstacle.flies()) add(obstacle.solid, obstacle.body->velocity(), &obstacle.rest);
    if (!obstacle.flies() && obstacle.solid.moves()) add(obstacle.solid, {0, 0, 0}, nullptr);
  }
  if (all_sleep) return;  // and nothing comes

  sleepers.insert(sleepers.end(), cloths.begin(), cloths.end());
  const std::vector<bool> at_rest = islands_at_rest(sleepers);
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (rests[i] == nullptr) continue;
    if (at_rest[i]) {
      rests[i]->sleep();
    } else if (rests[i]->asleep()) {
      rests[i]->wake();
    }
  }
  for (Ball& ball : balls_) {
    if (ball.rest.asleep()) ball.velocity = ball.spin = Vec3::Zero();
  }
  for (Obstacle& obstacle : obstacles_) {
    if (!obstacle.rest.asleep()) continue;
    obstacle.body->rest();
    obstacle.solid.stand();
  }
}

void Colliders::wake() {
  for (Ball& ball : balls_) ball.rest.wake();
  for (Obstacle& obstacle : obstacles_) obstacle.rest.wake();
}

void Colliders::wake_near(const Solid& solid) {
  const Eigen::AlignedBox3d box = box_of(solid, 0);
  for (Ball& ball : balls_) {
    if (box.intersects(box_of(ball.solid(), 0))) ball.rest.wake();
  }
  for (Obstacle& obstacle : obstacles_) {
    if (box.intersects(box_of(obstacle.solid, 0))) obstacle.rest.wake();
  }
}

void Colliders::watch(double dt) {
  const double distance = sleep_speed_ * kQuietSteps * dt;
  for (Ball& ball : balls_) {
    if (ball.awake()) ball.rest.stepped({ball.position, Quaternion::Identity()}, 0, distance);
  }
  for (Obstacle& obstacle : obstacles_) {
    if (obstacle.awake()) obstacle.rest.stepped(obstacle.pose, outer_radius(obstacle.solid.shape), distance);
  }
}

}  // namespace weft
