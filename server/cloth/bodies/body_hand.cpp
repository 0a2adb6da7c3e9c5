#include "cloth/bodies/body_hand.h"

#include <Eigen/LU>

namespace weft {
namespace {

/// The matrix of arm x.
Eigen::Matrix3d cross_matrix(const Vec3& arm) {
  Eigen::Matrix3d matrix;
  matrix << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return matrix;
}

Vec3 at_most(const Vec3& vector, double most) {
  const double length = vector.norm();
  return length > most ? Vec3(most / length * vector) : vector;
}

}  // namespace

void pull(const BodyHand& hand, RigidBody& body, const Pose& pose, const Vec3& gravity, double dt) {
  const double mass = body.mass(), most = hand.max_force * dt;
  const Eigen::Matrix3d inverse_inertia = body.inverse_inertia(pose.orientation);
  const Vec3 arm = pose.orientation * hand.point;
  const Eigen::Matrix3d lever = cross_matrix(arm);

  // turned = I w with (I + dt / time I_point) w = I w_before, which has no step too long either.
  const Eigen::Matrix3d inertia = inverse_inertia.inverse(), about_point = inertia - mass * lever * lever;
  const Vec3 before = body.angular_momentum();
  const Vec3 turned = inertia * ((inertia + dt / kGripTime * about_point).inverse() * before);
  body.strike(Vec3::Zero(), at_most(turned - before, most * kGripArm));

  // impulse = -dt (stiffness (stretch + dt v) + damping v), with v = velocity + inverse_mass impulse.
  const Vec3 stretch = pose.position + arm - hand.hand;
  const Vec3 velocity = body.velocity() + dt * gravity + body.spin(pose.orientation).cross(arm);
  const double stiffness = mass * kHandFrequency * kHandFrequency, damping = 2 * mass * kHandFrequency;
  const double softness = dt * (dt * stiffness + damping);
  const Eigen::Matrix3d inverse_mass = Eigen::Matrix3d::Identity() / mass - lever * inverse_inertia * lever;
  const Eigen::Matrix3d system = Eigen::Matrix3d::Identity() + softness * inverse_mass;
  const Vec3 impulse = at_most(-(system.inverse() * (dt * stiffness * stretch + softness * velocity)), most);
  body.strike(impulse, arm.cross(impulse));
}

}  // namespace weft
