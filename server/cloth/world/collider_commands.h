#pragma once
/// What is done to one ball, by its id, or obstacle of a simulation, by its place (command.h).
#include <cstddef>
#include <optional>

#include "cloth/core/grab_id.h"
#include "cloth/core/path.h"
#include "cloth/world/colliders.h"

namespace weft {
template <class Real>
class Simulation;
}  // namespace weft

namespace weft::command {

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

}  // namespace weft::command
