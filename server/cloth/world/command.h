#pragma once
/// What is done to a simulation between two steps, as data: so that it can be written down and done again.
/// Each is one of Simulation's calls, carry_out() makes it; of equal states and equal commands follow equal
/// states, to the bit.
#include <variant>

#include "cloth/world/simulation.h"

namespace weft::command {

struct RequestLevel {
  std::size_t cloth = 0;
  int level = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.request_level(cloth, level);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, level);
  }
};

/// Takes the level asked for at once, not before the next step. Returns whether it changed.
struct ApplyLevel {
  std::size_t cloth = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.cloths()[cloth].apply_pending_level();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth);
  }
};

struct SetResting {
  std::size_t cloth = 0;
  bool resting = false;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_resting(cloth, resting);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, resting);
  }
};

struct SetMostWork {
  std::size_t cloth = 0;
  double most = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.cloths()[cloth].set_most_work(most);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, most);
  }
};

struct TryAgain {
  std::size_t cloth = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.cloths()[cloth].try_again();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth);
  }
};

struct SetWind {
  Wind wind;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_wind(wind);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(wind);
  }
};

struct SetWindZone {
  std::size_t zone = 0;
  Vec3 velocity{0, 0, 0};
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_wind_zone(zone, velocity);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(zone, velocity);
  }
};

struct SetIntegrator {
  IntegratorDescription integrator;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_integrator(integrator);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(integrator);
  }
};

struct SetEffects {
  std::vector<EffectDescription> effects;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_effects(effects);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(effects);
  }
};

struct SetMaterial {
  std::size_t cloth = 0;
  Material material;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_material(cloth, material);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, material);
  }
};

struct SetBallFriction {
  BallId ball = 0;
  double friction = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.set_ball_friction(ball, friction);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(ball, friction);
  }
};

struct SetObstacleFriction {
  std::size_t obstacle = 0;
  double friction = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.set_obstacle_friction(obstacle, friction);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(obstacle, friction);
  }
};

struct AddBall {
  BallDescription ball;
  template <class Real>
  BallId carry_out(Simulation<Real>& simulation) const {
    return simulation.add_ball(ball);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(ball);
  }
};

struct MoveBall {
  BallId ball = 0;
  Vec3 target{0, 0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.move_ball(ball, target);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(ball, target);
  }
};

struct ThrowBall {
  BallId ball = 0;
  Vec3 velocity{0, 0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.throw_ball(ball, velocity);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(ball, velocity);
  }
};

struct RemoveBall {
  BallId ball = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.remove_ball(ball);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(ball);
  }
};

struct MoveObstacle {
  std::size_t obstacle = 0;
  Pose target;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.move_obstacle(obstacle, target);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(obstacle, target);
  }
};

struct ThrowObstacle {
  std::size_t obstacle = 0;
  Vec3 velocity{0, 0, 0}, spin{0, 0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.throw_obstacle(obstacle, velocity, spin);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(obstacle, velocity, spin);
  }
};

struct GrabCloth {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  std::optional<Vec3> hand;
  double max_force = 0;
  template <class Real>
  GrabId carry_out(Simulation<Real>& simulation) const {
    return simulation.grab(cloth, at, hand, max_force);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at, hand, max_force);
  }
};

struct GrabObstacle {
  std::size_t obstacle = 0;
  Vec3 point{0, 0, 0};
  std::optional<Vec3> hand;
  double max_force = 0;
  template <class Real>
  std::optional<GrabId> carry_out(Simulation<Real>& simulation) const {
    return simulation.grab_obstacle(obstacle, point, hand, max_force);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(obstacle, point, hand, max_force);
  }
};

struct MoveGrab {
  GrabId grab = 0;
  Vec3 hand{0, 0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.move_grab(grab, hand);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(grab, hand);
  }
};

struct Release {
  GrabId grab = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.release(grab);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(grab);
  }
};

struct Pin {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.pin(cloth, at);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at);
  }
};

struct Unpin {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.unpin(cloth, at);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at);
  }
};

struct Reset {
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.reset();
  }
  template <class Archive>
  void serialize(Archive&) {}
};

/// So many steps in a row.
struct Steps {
  std::uint32_t count = 1;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    for (std::uint32_t i = 0; i < count; ++i) simulation.step();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(count);
  }
};

using Command = std::variant<Steps, RequestLevel, ApplyLevel, SetResting, SetMostWork, TryAgain, SetWind,
                             SetWindZone, SetIntegrator, SetEffects, SetMaterial, SetBallFriction,
                             SetObstacleFriction, AddBall, MoveBall, ThrowBall, RemoveBall, MoveObstacle,
                             ThrowObstacle, GrabCloth, GrabObstacle, MoveGrab, Release, Pin, Unpin, Reset>;

}  // namespace weft::command
