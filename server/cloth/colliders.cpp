#include "cloth/colliders.h"

#include <algorithm>

#include "cloth/path.h"

namespace weft {
namespace {

/// Puts it there.
void take(Obstacle& obstacle, const Pose& pose) {
  obstacle.pose.position = obstacle.solid.position = pose.position;
  if (std::holds_alternative<HalfSpace>(obstacle.solid.shape)) return;
  obstacle.pose.orientation = pose.orientation;
  obstacle.solid.rotation = pose.orientation.toRotationMatrix();
}

Obstacle made_of(const ObstacleDescription& description, std::size_t index) {
  Obstacle obstacle;
  obstacle.pose.position = description.position;
  Shape& shape = obstacle.solid.shape;
  if (const auto* plane = std::get_if<PlaneDescription>(&description.shape)) {
    shape = HalfSpace{};
    obstacle.pose.orientation = Quaternion::FromTwoVectors(Vec3(0, 1, 0), plane->normal);
  } else if (const auto* box = std::get_if<BoxDescription>(&description.shape)) {
    shape = Box{box->size / 2};
    obstacle.pose.orientation = box->orientation;
  } else if (const auto* capsule = std::get_if<CapsuleDescription>(&description.shape)) {
    shape = Capsule{capsule->length / 2, capsule->radius};
    obstacle.pose.orientation = capsule->orientation;
  } else {
    const auto& mesh = std::get<MeshDescription>(description.shape);
    shape = Mesh{mesh.surface.get()};
    obstacle.surface = mesh.surface;
    obstacle.pose.orientation = mesh.orientation;
  }
  obstacle.path = description.path;
  obstacle.loops = description.loop;
  obstacle.mobile = !description.path.empty();
  Solid& solid = obstacle.solid;
  solid.id = kFirstObstacle + static_cast<ColliderId>(index);
  solid.friction = description.friction;
  solid.rotation = obstacle.pose.orientation.toRotationMatrix();
  if (obstacle.mobile) take(obstacle, along_path(obstacle.path, 0, obstacle.loops));
  solid.start = solid.position = obstacle.pose.position;
  if (description.body) {
    obstacle.body.emplace(*description.body, shape, obstacle.pose);
    obstacle.mobile = obstacle.mobile || obstacle.flies();
  }
  return obstacle;
}

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
  take(obstacle, to);  // `from` may be what it has
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

void Colliders::take_state(const Colliders& other) {
  std::vector<Obstacle> obstacles = other.obstacles_;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    obstacles[i].surface = obstacles_[i].surface;
    obstacles[i].solid.shape = obstacles_[i].solid.shape;
  }
  *this = other;
  obstacles_ = std::move(obstacles);
  gather_solids();
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
  if (id >= kFirstObstacle) {
    const std::size_t obstacle = id - kFirstObstacle;
    obstacles_[obstacle].body->share(cloths, solids_[balls_.size() + obstacle]);
    return;
  }
  const auto index = static_cast<std::size_t>(find_ball(balls_, id) - balls_.begin());
  balls_[index].sharing = cloths;
  solids_[index].inverse_mass = cloths / balls_[index].mass;
}

void Colliders::push(const std::vector<Solid>& left) {
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    balls_[i].pushed += (left[i].position - solids_[i].position) / balls_[i].sharing;
    balls_[i].sped_up += (left[i].velocity - solids_[i].velocity) / balls_[i].sharing;
  }
  for (std::size_t i = balls_.size(); i < solids_.size(); ++i) {
    if (solids_[i].yields()) obstacles_[i - balls_.size()].body->push(solids_[i], left[i]);
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

void Colliders::gather_solids() {
  solids_.clear();
  for (const Ball& ball : balls_) solids_.push_back(ball.solid());
  for (const Obstacle& obstacle : obstacles_) {
    solids_.push_back(obstacle.solid);
    solids_.back().mobile = obstacle.mobile;
  }
}

void Colliders::meet(BodyCollision& collision, double dt) {
  constexpr int kMostRounds = 4;
  constexpr double kStray = 1e-4;  // m
  for (int round = 0; round < kMostRounds; ++round) {
    if (!(bend_ways(collision, dt) > kStray)) return;
  }
}

double Colliders::bend_ways(BodyCollision& collision, double dt) {
  gather_solids();
  const std::vector<BodyContact>& contacts = collision.find(solids_, dt);
  if (contacts.empty()) return 0;
  std::vector<MovingBody> bodies;
  for (const Solid& solid : solids_) {
    bodies.push_back({solid.inverse_mass, solid.inverse_inertia, solid.velocity, solid.spin});
  }
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    if (!ball.awake()) continue;
    bodies[i].inverse_inertia.diagonal().setConstant(2.5 / (ball.mass * ball.radius * ball.radius));
    bodies[i].spin = ball.spin;
  }
  resolve(contacts, bodies, dt);
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
