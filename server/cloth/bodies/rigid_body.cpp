#include "cloth/bodies/rigid_body.h"

#include <Eigen/LU>
#include <numbers>
#include <utility>

#include "cloth/shapes/mass_properties.h"

namespace weft {
namespace {

/// About the axis `turn` by its length, rad.
Quaternion turning(const Vec3& turn) {
  return Quaternion(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
}

/// The shorter way round, about this axis by its length, rad.
Vec3 turn_between(const Quaternion& from, const Quaternion& to) {
  Quaternion turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const Eigen::AngleAxisd angle_axis(turn);
  return angle_axis.angle() * angle_axis.axis();
}

/// The pose as it is, the solid there.
void put(Solid& solid, const Pose& pose) {
  solid.position = pose.position;
  solid.rotation = pose.orientation.toRotationMatrix();
}

}  // namespace

RigidBody::RigidBody(const BodyDescription& description, const Shape& shape, const Pose& pose)
    : dynamic_(description.dynamic),
      mass_(description.mass),
      inertia_(description.mass * mass_properties(shape).inertia),
      inverse_inertia_(inertia_.inverse()),
      velocity_(description.velocity),
      turning_(0, 0, 0),
      start_(pose) {
  if (dynamic_) fling(description.velocity, description.spin, pose.orientation);
}

Eigen::Matrix3d RigidBody::inverse_inertia(const Quaternion& orientation) const {
  const Eigen::Matrix3d axes = orientation.toRotationMatrix();
  return axes * inverse_inertia_ * axes.transpose();
}

Vec3 RigidBody::spin(const Quaternion& orientation) const { return inverse_inertia(orientation) * turning_; }

void RigidBody::fling(const Vec3& velocity, const Vec3& spin, const Quaternion& orientation) {
  const Eigen::Matrix3d axes = orientation.toRotationMatrix();
  dynamic_ = true;
  velocity_ = velocity;
  turning_ = axes * (inertia_ * (axes.transpose() * spin));
}

void RigidBody::strike(const Vec3& impulse, const Vec3& turning) {
  velocity_ += impulse / mass_;
  turning_ += turning;
}

/// Fixed-point iterations, each of which wins digits as long as the body turns by little in the step.
Vec3 RigidBody::middle_spin(const Quaternion& orientation, double dt) const {
  constexpr int kIterations = 20;
  Vec3 found = spin(orientation);
  for (int i = 0; i < kIterations; ++i) {
    const Vec3 next = spin(turning(dt / 2 * found) * orientation);
    if (next == found) break;
    found = next;
  }
  return found;
}

void RigidBody::fly(Pose& pose, Solid& solid, const Vec3& gravity, double dt) {
  // Faster and a step would be taken for a turn the other way; what goes beyond is lost.
  constexpr double kMostTurn = std::numbers::pi;
  sharing_ = 1;
  start_ = pose;
  velocity_ += gravity * dt;
  Vec3 spin = middle_spin(pose.orientation, dt);
  if (const double turn = dt * spin.norm(); turn > kMostTurn) {
    turning_ *= kMostTurn / turn;
    spin *= kMostTurn / turn;
  }
  solid.start = pose.position;
  solid.velocity = velocity_;
  solid.spin = spin;
  solid.turn = dt * spin;
  solid.inverse_mass = 1 / mass_;
  solid.inverse_inertia = inverse_inertia(turning(solid.turn / 2) * pose.orientation);
  pose.position += dt * velocity_;
  pose.orientation = (turning(solid.turn) * pose.orientation).normalized();
  put(solid, pose);
}

void RigidBody::share(int cloths, Solid& solid) {
  sharing_ = cloths;
  solid.inverse_mass *= cloths;
  solid.inverse_inertia *= cloths;
}

void RigidBody::push(const Solid& solid, const Solid& left) {
  pushed_ += (left.position - solid.position) / sharing_;
  sped_up_ += (left.velocity - solid.velocity) / sharing_;
  if (left.spin == solid.spin) return;
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(left.rotation * solid.rotation.transpose()));
  turned_ += turned.angle() / sharing_ * turned.axis();
  spun_up_ += solid.inverse_inertia.inverse() * (left.spin - solid.spin);
}

bool RigidBody::take_up(Pose& pose, Solid& solid) {
  const bool given = !pushed_.isZero(0) || !sped_up_.isZero(0) || !turned_.isZero(0) || !spun_up_.isZero(0);
  pose.position += std::exchange(pushed_, Vec3(0, 0, 0));
  velocity_ += std::exchange(sped_up_, Vec3(0, 0, 0));
  pose.orientation = (turning(std::exchange(turned_, Vec3(0, 0, 0))) * pose.orientation).normalized();
  turning_ += std::exchange(spun_up_, Vec3(0, 0, 0));
  put(solid, pose);
  return given;
}

void RigidBody::lead(const Pose& pose, Solid& solid) const {
  solid.start = start_.position;
  solid.velocity = velocity_;
  solid.spin = spin(pose.orientation);
  solid.turn = turn_between(start_.orientation, pose.orientation);
  put(solid, pose);
}

void RigidBody::go_on(const MovingBody& with, Pose& pose, Solid& solid, double dt) {
  const Vec3 spun_up = with.spin - solid.spin;
  pose.position += dt * (with.velocity - velocity_) + with.shift;
  pose.orientation = (turning(dt * spun_up + with.turn) * pose.orientation).normalized();
  velocity_ = with.velocity;
  if (!spun_up.isZero(0)) turning_ += with.inverse_inertia.inverse() * spun_up;
  lead(pose, solid);
  solid.spin = with.spin;
}

bool RigidBody::sound(const Pose& pose, double farthest) const {
  const auto good = [&](const auto& v) { return (v.array().abs() <= farthest).all(); };
  return good(pose.position) && good(pose.orientation.coeffs()) && good(velocity_) && good(turning_);
}

void RigidBody::stop(Pose& pose, Solid& solid) {
  pose = start_;
  velocity_ = turning_ = solid.velocity = solid.turn = solid.spin = Vec3::Zero();
  solid.start = pose.position;
  solid.inverse_inertia.setZero();  // of a pose that was no good
  put(solid, pose);
}

}  // namespace weft
