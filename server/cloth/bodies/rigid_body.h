#pragma once
#include "cloth/bodies/body_impulses.h"
#include "cloth/bodies/collider_description.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A body that flies, turns and takes up what cloths give it: the state that a Solid, which is how it goes in
/// one step, is made of and gives back. Its solid's centre is its centre of mass.
///
/// Its turning is kept as angular momentum, which nothing but the cloths changes: the gyroscopic term of
/// Euler's equations is the change of the inertia in the world. The spin of a step is that of its middle
/// (implicit midpoint rule: second order and time-reversible, so that the energy sways and does not drift;
/// Hairer, Lubich, Wanner, Geometric Numerical Integration, 2006, VII.5). It keeps the angular momentum to
/// the bit, and so the energy is bounded whatever the step, between what this momentum has about the body's
/// stiffest and about its slackest axis.
class RigidBody {
 public:
  /// Of that shape, at that place and orientation. Throws std::invalid_argument as mass_properties does.
  RigidBody(const BodyDescription& description, const Shape& shape, const Pose& pose);

  bool dynamic() const { return dynamic_; }
  double mass() const { return mass_; }                        ///< kg
  const Eigen::Matrix3d& inertia() const { return inertia_; }  ///< along its own axes, kg m2
  const Vec3& velocity() const { return velocity_; }           ///< m/s
  const Vec3& angular_momentum() const { return turning_; }    ///< about its centre, in the world, N m s
  int sharing() const { return sharing_; }                     ///< as Ball::sharing
  /// With the body as it is turned, rad/s, in the world.
  Vec3 spin(const Quaternion& orientation) const;
  /// The same, 1/(kg m2).
  Eigen::Matrix3d inverse_inertia(const Quaternion& orientation) const;

  /// It goes where it is told from now on; `fly` and the rest are not for it until it is thrown.
  void hold() { dynamic_ = false; }
  /// It flies off.
  void fling(const Vec3& velocity, const Vec3& spin, const Quaternion& orientation);
  /// What it is given between two steps: of momentum, N s, and of angular momentum, N m s.
  void strike(const Vec3& impulse, const Vec3& turning);
  /// A step of dt, s, by `gravity`, m/s2: the pose becomes that of the step's end, the solid its way.
  void fly(Pose& pose, Solid& solid, const Vec3& gravity, double dt);
  /// So many cloths touch it in the step: Colliders::share.
  void share(int cloths, Solid& solid);
  /// A cloth leaves it as `left` that got it as `solid`, both as seen from one place.
  void push(const Solid& solid, const Solid& left);
  /// At the step's end: the pose and the solid with what the cloths gave. False if they gave nothing.
  bool take_up(Pose& pose, Solid& solid);
  /// The solid goes from where the step began to the pose, as the body goes there.
  void lead(const Pose& pose, Solid& solid) const;
  /// Contact with other bodies and obstacles, in a step of dt, s: it goes on as `with` says from where the
  /// step began; pose and solid, which was led there, as well.
  void go_on(const MovingBody& with, Pose& pose, Solid& solid, double dt);
  /// All of it and of the pose is a number, and none beyond `farthest`.
  bool sound(const Pose& pose, double farthest) const;
  /// It is at rest where it is.
  void rest() { velocity_ = turning_ = Vec3::Zero(); }
  /// Back to where the last step began, at rest.
  void stop(Pose& pose, Solid& solid);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(dynamic_, velocity_, turning_, start_, sharing_, pushed_, sped_up_, turned_, spun_up_);
  }

 private:
  Vec3 middle_spin(const Quaternion& orientation, double dt) const;

  bool dynamic_;
  double mass_;
  Eigen::Matrix3d inertia_, inverse_inertia_;
  Vec3 velocity_, turning_;
  Pose start_;  ///< of the step
  int sharing_ = 1;
  // What the cloths gave it in the step.
  Vec3 pushed_{0, 0, 0}, sped_up_{0, 0, 0}, turned_{0, 0, 0}, spun_up_{0, 0, 0};  ///< m, m/s, rad, N m s
};

}  // namespace weft
