#pragma once
#include <cstddef>

#include "cloth/bodies/rigid_body.h"
#include "cloth/core/grab_id.h"

namespace weft {

/// A hand on a body: it holds a point of it and pulls that to where it is.
struct BodyHand {
  GrabId id = 0;
  std::size_t obstacle = 0;  ///< the body, by its place in Colliders::obstacles()
  Vec3 point{0, 0, 0};       ///< what it holds, from the body's centre along its own axes, m
  Vec3 hand{0, 0, 0};        ///< m
  double max_force = 100;    ///< N, > 0; what it is pulled beyond it slips behind
  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, obstacle, point, hand, max_force);
  }
};

/// Gives the body what the hand does to it in a step of dt, s, in which gravity, m/s2, gets it next: the
/// impulse at the point of a critically damped spring that the body swings on at kHandFrequency, of at most
/// max_force. It is that of the spring at the end of the step, so that no step is too long (soft constraint:
/// Catto, Soft Constraints, GDC 2011). The body hangs g / kHandFrequency^2 = 1.1 cm below the hand whatever
/// it weighs. The grip slows its turning about the point at the rate 1 / kGripTime, with at most the torque
/// of max_force over kGripArm.
void pull(const BodyHand& hand, RigidBody& body, const Pose& pose, const Vec3& gravity, double dt);

inline constexpr double kHandFrequency = 30;  ///< rad/s
inline constexpr double kGripTime = 0.2;      ///< s
inline constexpr double kGripArm = 0.1;       ///< m

}  // namespace weft
