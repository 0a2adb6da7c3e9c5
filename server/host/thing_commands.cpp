/// LiveScene's commands to the things in it, balls, obstacles, hands and pins: what each does, and when it is
/// refused.
#include <algorithm>
#include <cmath>

#include "host/live_scene.h"
#include "host/refusal.h"
#include "host/scene_messages.h"
#include "protocol/member.h"

namespace weft::host {
namespace {

using nlohmann::json;
using protocol::Error;

Error no_such_ball(BallId id) {
  return refused("not_found", "/ball", "/ball is " + std::to_string(id) + "; the scene has no such ball");
}

Error no_such_obstacle(std::uint32_t obstacle, std::size_t obstacles) {
  return refused("not_found", "/obstacle",
                 "/obstacle is " + std::to_string(obstacle) + "; the scene has " + std::to_string(obstacles) +
                     " obstacles, counted from 0");
}

Error no_mass(std::uint32_t obstacle) {
  return refused("unavailable", "/obstacle", "/obstacle is " + std::to_string(obstacle) + "; it has no mass");
}

Error no_such_grab(GrabId id) {
  return refused("not_found", "/grab",
                 "/grab is " + std::to_string(id) + "; this viewer holds nothing by that id");
}

}  // namespace

std::optional<Error> LiveScene::too_large(double radius) const {
  double most = 0;
  for (const ClothDescription& cloth : scene_.simulation.cloths) most = std::max(most, cloth.size.norm());
  most = std::ceil(100 * most) / 100;
  if (radius <= most) return {};
  const auto fault = protocol::refuse(
      "range", "/radius", radius, protocol::range_text({0.01, most, "m, in this scene: its cloth's size"}));
  return refused("range", "/radius", fault.message);
}

std::optional<Error> LiveScene::may_not_put(const Seat& seat) const {
  if (simulation_.step_count() >= seat.puts_again_at) return {};
  return refused(
      "limit", "",
      "what this viewer put made a step take too much work; it may put something again from step " +
          std::to_string(seat.puts_again_at) + " on");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallAdd& add, Seat& seat) {
  if (const auto not_now = may_not_put(seat)) return *not_now;
  if (const auto large = too_large(add.radius)) return *large;
  if (simulation_.colliders().balls().size() >= static_cast<std::size_t>(limits_.balls)) {
    return refused("limit", "",
                   "the scene has " + std::to_string(limits_.balls) + " balls, the most allowed");
  }
  BallDescription ball;
  ball.position = to_vec3(add.position);
  ball.radius = add.radius;
  ball.velocity = to_vec3(add.velocity);
  ball.motion = add.motion == protocol::Motion::dynamic ? BallDescription::Motion::dynamic
                                                        : BallDescription::Motion::kinematic;
  ball.mass = add.mass;
  ball.friction = add.friction;
  const BallId id = recorded_.run(command::AddBall{ball});
  put_bodies_.put(id, seat.number, simulation_);
  balls_changed("ball.add", takes_effect_, id);
  return json{{"ball", id}};
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallMove& move, Seat& seat) {
  if (const auto not_now = may_not_put(seat)) return *not_now;
  if (!recorded_.run(command::MoveBall{move.ball, to_vec3(move.position)})) return no_such_ball(move.ball);
  put_bodies_.put(move.ball, seat.number, simulation_);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallThrow& thrown, Seat& seat) {
  if (const auto not_now = may_not_put(seat)) return *not_now;
  if (!recorded_.run(command::ThrowBall{thrown.ball, to_vec3(thrown.velocity)}))
    return no_such_ball(thrown.ball);
  put_bodies_.put(thrown.ball, seat.number, simulation_);
  balls_changed("ball.throw", takes_effect_, thrown.ball);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallRemove& remove, Seat&) {
  if (!remove_ball(remove.ball)) return no_such_ball(remove.ball);
  balls_changed("ball.remove", takes_effect_, remove.ball);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleMove& move, Seat& seat) {
  if (const auto not_now = may_not_put(seat)) return *not_now;
  const auto& obstacles = simulation_.colliders().obstacles();
  if (move.obstacle >= obstacles.size()) return no_such_obstacle(move.obstacle, obstacles.size());
  Pose pose{to_vec3(move.position), obstacles[move.obstacle].pose.orientation};
  if (move.quaternion) {
    const protocol::Turn& q = *move.quaternion;
    pose.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  }
  put_bodies_.put(kFirstObstacle + move.obstacle, seat.number, simulation_);
  recorded_.run(command::MoveObstacle{move.obstacle, pose});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleThrow& thrown, Seat& seat) {
  if (const auto not_now = may_not_put(seat)) return *not_now;
  const auto& obstacles = simulation_.colliders().obstacles();
  if (thrown.obstacle >= obstacles.size()) return no_such_obstacle(thrown.obstacle, obstacles.size());
  if (!obstacles[thrown.obstacle].body) return no_mass(thrown.obstacle);
  put_bodies_.put(kFirstObstacle + thrown.obstacle, seat.number, simulation_);
  recorded_.run(command::ThrowObstacle{thrown.obstacle, to_vec3(thrown.velocity), to_vec3(thrown.spin)});
  return json::object();
}

std::optional<Error> LiveScene::too_many_grabs() const {
  std::size_t held = simulation_.colliders().hands().size();
  for (const Cloth<float>& cloth : simulation_.cloths()) held += cloth.grabs().size();
  if (held < static_cast<std::size_t>(limits_.grabs)) return {};
  return refused("limit", "",
                 "the scene is held at " + std::to_string(limits_.grabs) + " points, the most allowed");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleGrab& grab, Seat& seat) {
  const std::size_t obstacles = simulation_.colliders().obstacles().size();
  if (grab.obstacle >= obstacles) return no_such_obstacle(grab.obstacle, obstacles);
  if (const auto too_many = too_many_grabs()) return *too_many;
  std::optional<Vec3> hand;
  if (grab.position) hand = to_vec3(*grab.position);
  const auto id =
      recorded_.run(command::GrabObstacle{grab.obstacle, to_vec3(grab.point), hand, grab.max_force});
  if (!id) return no_mass(grab.obstacle);
  put_bodies_.put(kFirstObstacle + grab.obstacle, seat.number, simulation_);
  seat.grabs.push_back(*id);
  return json{{"grab", *id}};
}

std::optional<Error> LiveScene::missing_cloth(std::uint32_t cloth) const {
  const std::size_t cloths = simulation_.cloths().size();
  if (cloth < cloths) return {};
  return refused("not_found", "/cloth",
                 "/cloth is " + std::to_string(cloth) + "; the scene has " + std::to_string(cloths) +
                     " cloths, counted from 0");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothGrab& grab, Seat& seat) {
  if (const auto missing = missing_cloth(grab.cloth)) return *missing;
  if (const auto too_many = too_many_grabs()) return *too_many;
  std::optional<Vec3> hand;
  if (grab.position) hand = to_vec3(*grab.position);
  const GrabId id = recorded_.run(command::GrabCloth{grab.cloth, {grab.u, grab.v}, hand, grab.max_force});
  seat.grabs.push_back(id);
  return json{{"grab", id}};
}

LiveScene::Outcome LiveScene::carry_out(const protocol::GrabMove& move, Seat& seat) {
  if (std::find(seat.grabs.begin(), seat.grabs.end(), move.grab) == seat.grabs.end()) {
    return no_such_grab(move.grab);
  }
  recorded_.run(command::MoveGrab{move.grab, to_vec3(move.position)});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::GrabRelease& release, Seat& seat) {
  if (std::erase(seat.grabs, release.grab) == 0) return no_such_grab(release.grab);
  recorded_.run(command::Release{release.grab});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothPin& pin, Seat&) {
  if (const auto missing = missing_cloth(pin.cloth)) return *missing;
  if (simulation_.cloths()[pin.cloth].description().pins.size() >= kMaxPins) {
    return refused("limit", "", "the cloth has " + std::to_string(kMaxPins) + " pins, the most allowed");
  }
  recorded_.run(command::Pin{pin.cloth, {pin.u, pin.v}});
  pins_changed("cloth.pin", pin.cloth);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothUnpin& unpin, Seat&) {
  if (const auto missing = missing_cloth(unpin.cloth)) return *missing;
  if (!recorded_.run(command::Unpin{unpin.cloth, {unpin.u, unpin.v}})) {
    return refused("not_found", "/cloth", "/cloth is " + std::to_string(unpin.cloth) + "; it has no pins");
  }
  pins_changed("cloth.unpin", unpin.cloth);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::FrictionSet& set, Seat&) {
  const Colliders& colliders = simulation_.colliders();
  const auto frictions = [&] {
    return json{{"balls", balls_json(colliders)}, {"frictions", frictions_json(colliders)}};
  };
  const json before = frictions(), studied_before = studied_json();
  if (set.ball) {
    if (!recorded_.run(command::SetBallFriction{*set.ball, set.friction})) return no_such_ball(*set.ball);
  } else if (set.obstacle) {
    if (!recorded_.run(command::SetObstacleFriction{*set.obstacle, set.friction}))
      return no_such_obstacle(*set.obstacle, colliders.obstacles().size());
  } else {
    for (const Ball& ball : colliders.balls()) recorded_.run(command::SetBallFriction{ball.id, set.friction});
    for (std::size_t i = 0; i < colliders.obstacles().size(); ++i)
      recorded_.run(command::SetObstacleFriction{i, set.friction});
  }
  if (frictions() == before) return json::object();
  if (studied_json() != studied_before) study_outdated();
  frictions_changed();
  return json::object();
}

void LiveScene::frictions_changed() {
  events_.add("friction", "", takes_effect_, [this] {
    return json{{"balls", balls_json(simulation_.colliders())},
                {"frictions", frictions_json(simulation_.colliders())}};
  });
}

}  // namespace weft::host
