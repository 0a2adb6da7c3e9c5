/// Colliders in a step: how they go, meet, and take up what cloths give them.
#include <algorithm>
#include <utility>

#include "cloth/core/path.h"
#include "cloth/world/colliders.h"

namespace weft {
namespace {

/// It goes from pose to pose in a step of dt, s.
void go(Obstacle& obstacle, const Pose& from, const Pose& to, double dt) {
  Solid& solid = obstacle.solid;
  solid.start = from.position;
  solid.velocity = (to.position - from.position) / dt;
  if (!std::holds_alternative<HalfSpace>(solid.shape)) {
    Quaternion turn = to.orientation * from.orientation.conjugate();
    if (turn.w() < 0) turn.coeffs() *= -1;  // the shorter way round
    const Eigen::AngleAxisd angle_axis(turn);
    solid.turn = angle_axis.angle() * angle_axis.axis();
    solid.spin = solid.turn / dt;
  }
  obstacle.take(to);  // `from` may be what it has
}

/// Along its path or to its target, in the first of so many steps from `time` on.
void advance(Obstacle& obstacle, double time, double dt, int steps) {
  obstacle.solid.stand();
  if (obstacle.target && steps == 1) {
    go(obstacle, obstacle.pose, *obstacle.target, dt);
    obstacle.target.reset();
  } else if (obstacle.target) {
    const auto& [position, orientation] = obstacle.pose;
    go(obstacle, obstacle.pose,
       {position + (obstacle.target->position - position) / steps,
        orientation.slerp(1.0 / steps, obstacle.target->orientation)},
       dt);
  } else if (!obstacle.path.empty()) {
    const auto pose = [&](double when) { return along_path(obstacle.path, when, obstacle.loops); };
    go(obstacle, pose(time), pose(time + dt), dt);
  }
}

/// The contacts of two solids bear in equal parts what these were pushed apart by.
void bear(const std::vector<BodyTouch>& pushed, std::vector<BodyContact>& contacts) {
  const auto same = [](const BodyContact& contact, const BodyTouch& touch) {
    const auto a = static_cast<std::size_t>(contact.a), b = static_cast<std::size_t>(contact.b);
    return (a == touch.a() && b == touch.b()) || (a == touch.b() && b == touch.a());
  };
  for (const BodyTouch& touch : pushed) {
    if (!(touch.impulse > 0)) continue;
    const auto count = std::count_if(contacts.begin(), contacts.end(),
                                     [&](const BodyContact& contact) { return same(contact, touch); });
    for (BodyContact& contact : contacts) {
      if (same(contact, touch)) contact.borne += touch.impulse / static_cast<double>(count);
    }
  }
}

}  // namespace

void Colliders::begin_step(double time, double dt, const Vec3& gravity, const std::vector<Sleeper>& cloths,
                           int parts_left) {
  for (Ball& ball : balls_) {
    ball.start = ball.position;
    ball.sharing = 1;
    if (!ball.path.empty()) {
      ball.start = along_path(ball.path, time, ball.loops);
      ball.position = along_path(ball.path, time + dt, ball.loops);
      ball.velocity = (ball.position - ball.start) / dt;
      continue;
    }
    if (ball.flies()) continue;
    const auto target =
        std::find_if(targets_.begin(), targets_.end(), [&](const Target& t) { return t.ball == ball.id; });
    if (target == targets_.end()) {
      ball.position += ball.velocity * dt;
    } else if (target->reached) {
      ball.velocity.setZero();
      targets_.erase(target);
    } else {
      target->reached = parts_left == 1;
      ball.position =
          target->reached ? target->position : ball.start + (target->position - ball.start) / parts_left;
      ball.velocity = (ball.position - ball.start) / dt;
    }
  }
  for (Obstacle& obstacle : obstacles_) {
    if (obstacle.mobile && !obstacle.flies()) advance(obstacle, time, dt, parts_left);
  }
  for (const BodyHand& hand : hands_) obstacles_[hand.obstacle].rest.wake();
  if (may_rest()) let_sleep(dt, gravity, cloths);
  for (Ball& ball : balls_) {
    if (!ball.awake() || !ball.path.empty()) continue;
    ball.velocity += gravity * dt;
    ball.position += ball.velocity * dt;
  }
  stop_bad_balls();
  for (const BodyHand& hand : hands_) {
    Obstacle& held = obstacles_[hand.obstacle];
    if (held.flies()) pull(hand, *held.body, held.pose, gravity, dt);
  }
  for (Obstacle& obstacle : obstacles_) {
    if (!obstacle.awake()) continue;
    obstacle.body->fly(obstacle.pose, obstacle.solid, gravity, dt);
    stop_bad_body(obstacle);
  }
  gather_solids();
}

void Colliders::share(ColliderId id, int cloths) {
  const auto solid =
      std::find_if(solids_.begin(), solids_.end(), [&](const Solid& each) { return each.id == id; });
  const auto index = static_cast<std::size_t>(solid - solids_.begin());
  if (index >= balls_.size()) {
    obstacles_[index - balls_.size()].body->share(cloths, *solid);
    return;
  }
  balls_[index].sharing = cloths;
  solid->inverse_mass = cloths / balls_[index].mass;
}

void Colliders::push(const std::vector<Solid>& met, const std::vector<Solid>& left) {
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    balls_[i].pushed += (left[i].position - met[i].position) / balls_[i].sharing;
    balls_[i].sped_up += (left[i].velocity - met[i].velocity) / balls_[i].sharing;
  }
  for (std::size_t i = balls_.size(); i < solids_.size(); ++i) {
    if (solids_[i].yields()) obstacles_[i - balls_.size()].body->push(met[i], left[i]);
  }
}

bool Colliders::end_step() {
  bool given = false;
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    Ball& ball = balls_[i];
    ball.just_put = false;
    if (!ball.awake()) continue;
    given = given || !ball.pushed.isZero(0) || !ball.sped_up.isZero(0);
    ball.position += std::exchange(ball.pushed, Vec3(0, 0, 0));
    ball.velocity += std::exchange(ball.sped_up, Vec3(0, 0, 0));
    solids_[i].position = ball.position;
  }
  stop_bad_balls();
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    Obstacle& obstacle = obstacles_[i];
    if (!obstacle.awake()) continue;
    given = obstacle.body->take_up(obstacle.pose, solids_[balls_.size() + i]) || given;
    obstacle.body->lead(obstacle.pose, obstacle.solid);
    stop_bad_body(obstacle);
  }
  return given;
}

bool Colliders::may_meet() const {
  return balls_.size() + obstacles_.size() > 1 &&
         (std::any_of(balls_.begin(), balls_.end(), [](const Ball& ball) { return ball.awake(); }) ||
          std::any_of(obstacles_.begin(), obstacles_.end(), [](const Obstacle& o) { return o.awake(); }));
}

void Colliders::meet(BodyCollision& collision, double dt, const std::vector<PinnedNode>& pins,
                     const std::vector<BodyTouch>* pushed) {
  constexpr int kMostRounds = 4;
  constexpr double kStray = 1e-4;  // m
  for (int round = 0; round < kMostRounds; ++round) {
    gather_solids();
    std::vector<BodyContact> contacts = collision.find(solids_, dt, pins);
    const bool begins = round == 0 && pushed == nullptr;
    if (begins) impulses_.start(contacts, solids_, dt);
    if (round == 0 && pushed != nullptr) bear(*pushed, contacts);
    std::vector<BodyImpulse> impulses;
    const double stray = bend_ways(contacts, dt, pins, impulses);
    if (begins) impulses_.keep(contacts, impulses, solids_, dt);
    if (!(stray > kStray)) return;
  }
}

std::vector<BodyTouch> Colliders::touches(const BodyCollision& collision) const {
  std::vector<BodyTouch> touches;
  for (const BodyContact& contact : collision.found()) {
    if (static_cast<std::size_t>(contact.b) < solids_.size()) touches.emplace_back(contact, solids_);
  }
  return touches;
}

double Colliders::bend_ways(const std::vector<BodyContact>& contacts, double dt,
                            const std::vector<PinnedNode>& pins, std::vector<BodyImpulse>& impulses) {
  if (contacts.empty()) return 0;
  std::vector<MovingBody> bodies;
  for (const Solid& solid : solids_) {
    bodies.push_back({solid.inverse_mass, solid.inverse_inertia, solid.velocity, solid.spin});
  }
  for (const PinnedNode& pin : pins) bodies.push_back({.velocity = pin.node.velocity});
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    if (!ball.awake()) continue;
    bodies[i].inverse_inertia.diagonal().setConstant(2.5 / (ball.mass * ball.radius * ball.radius));
    bodies[i].spin = ball.spin;
  }
  impulses = resolve(contacts, bodies, dt);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    Ball& ball = balls_[i];
    if (!ball.awake()) continue;
    ball.position += dt * (bodies[i].velocity - ball.velocity) + bodies[i].shift;
    ball.velocity = bodies[i].velocity;
    ball.spin = bodies[i].spin;
  }
  stop_bad_balls();
  double stray = 0;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    Obstacle& obstacle = obstacles_[i];
    if (!obstacle.awake()) continue;
    const MovingBody& with = bodies[balls_.size() + i];
    const Vec3& spin = obstacle.solid.spin;
    const double turn = dt * (with.spin - spin).norm();
    stray = std::max(stray, turn * (turn + dt * spin.norm()) / 2 * outer_radius(obstacle.solid.shape));
    obstacle.body->go_on(with, obstacle.pose, obstacle.solid, dt);
    stop_bad_body(obstacle);
  }
  gather_solids();
  return stray;
}

void Colliders::stop_bad_body(Obstacle& obstacle) {
  if (obstacle.body->sound(obstacle.pose, kFarthest)) return;
  obstacle.body->stop(obstacle.pose, obstacle.solid);
  stopped_.push_back(obstacle.solid.id);
}

void Colliders::stop_bad_balls() {
  const auto good = [](const Vec3& v) { return (v.array().abs() <= kFarthest).all(); };
  for (Ball& ball : balls_) {
    if (good(ball.position) && good(ball.velocity)) continue;
    if (!good(ball.start)) ball.start.setZero();  // it never had a good place
    if (!good(ball.position)) ball.position = ball.start;
    ball.velocity.setZero();
    ball.spin.setZero();
    ball.path.clear();
    forget_target(ball.id);
    stopped_.push_back(ball.id);
  }
}

}  // namespace weft
