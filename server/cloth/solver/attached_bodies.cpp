#include "cloth/solver/attached_bodies.h"

#include <Eigen/LU>
#include <algorithm>

namespace weft {
namespace {

/// v x.
Eigen::Matrix3d cross_of(const Vec3& v) {
  return Eigen::Matrix3d{{0, -v.z(), v.y()}, {v.z(), 0, -v.x()}, {-v.y(), v.x(), 0}};
}

}  // namespace

template <class Real>
void AttachedBodies<Real>::Body::hold(const Vec3& arm, const Eigen::Matrix3d& by) {
  const Eigen::Matrix3d lever = cross_of(arm), coupled = -by * lever;
  stiffness += by;
  coupling += coupled;
  turning += lever * coupled;
}

template <class Real>
JoinedBodies::Matrix6 AttachedBodies<Real>::Body::matrix() const {
  JoinedBodies::Matrix6 all;
  all << inertia * Eigen::Matrix3d::Identity() + stiffness, coupling, coupling.transpose(),
      turning_inertia + turning;
  return all;
}

template <class Real>
void AttachedBodies<Real>::Body::invert() {
  inverse = (inertia * Eigen::Matrix3d::Identity() + stiffness).inverse();
  inverse_turning = (turning_inertia + turning - coupling.transpose() * inverse * coupling).inverse();
}

template <class Real>
auto AttachedBodies<Real>::Body::solve(const Screw& f) const -> Screw {
  const Vec3 turn = inverse_turning * (f.turn - coupling.transpose() * (inverse * f.shift));
  return {inverse * (f.shift - coupling * turn), turn};
}

template <class Real>
void AttachedBodies<Real>::clear() {
  bodies_.clear();
  springs_.clear();
  pushes_.clear();
  joints_.clear();
}

template <class Real>
int AttachedBodies<Real>::add(double inertia, const Eigen::Matrix3d& turning_inertia) {
  bodies_.push_back({inertia, turning_inertia});
  return static_cast<int>(bodies_.size()) - 1;
}

template <class Real>
void AttachedBodies<Real>::reset() {
  for (Body& body : bodies_) body.move = Screw{};
}

template <class Real>
void AttachedBodies<Real>::detach() {
  springs_.clear();
  for (Body& body : bodies_) {
    body.stiffness.setZero();
    body.coupling.setZero();
    body.turning.setZero();
    body.force = {-body.inertia * body.move.shift, -body.turning_inertia * body.move.turn};
  }
  push_apart();
}

template <class Real>
void AttachedBodies<Real>::attach(int body, const ClothPoint<Real>& point, const Vec3& arm,
                                  const Eigen::Matrix3d& stiffness, const Vec3& force) {
  const auto index = static_cast<std::size_t>(body);
  Body& hung = bodies_[index];
  hung.hold(arm, stiffness);
  hung.force.add_force(-force, arm);
  springs_.push_back({index, point, arm, stiffness});
}

template <class Real>
void AttachedBodies<Real>::eliminate(kernels::Components<Real> b) {
  if (joints_.empty()) {
    for (Body& body : bodies_) body.invert();
  } else {
    std::vector<JoinedBodies::Matrix6> own;
    own.reserve(bodies_.size());
    for (const Body& body : bodies_) own.push_back(body.matrix());
    joined_.factorise(own, joints_);
  }
  sums_.clear();
  for (const Body& body : bodies_) sums_.push_back(body.force);
  solve(sums_);
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].change = sums_[i];
  for (const Spring& spring : springs_) {
    spring.point.add_force(b, spring.stiffness * bodies_[spring.body].change.at(spring.arm));
  }
}

template <class Real>
double AttachedBodies<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const {
  sums_.assign(bodies_.size(), Screw{});
  for (const Spring& spring : springs_) {
    sums_[spring.body].add_force(spring.stiffness * spring.point.moved_by(x), spring.arm);
  }
  forces_ = sums_;
  solve(sums_);
  double product = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) product -= forces_[i].dot(sums_[i]);
  for (const Spring& spring : springs_) {
    spring.point.add_force(y, -spring.stiffness * sums_[spring.body].at(spring.arm));
  }
  return product;
}

template <class Real>
double AttachedBodies<Real>::find_changes(kernels::Components<const Real> x) {
  forces_.clear();
  for (const Body& body : bodies_) forces_.push_back(body.force);
  sums_ = forces_;
  solve(sums_);
  double decrease = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) decrease += forces_[i].dot(sums_[i]) / 2;
  for (const Spring& spring : springs_) {
    forces_[spring.body].add_force(spring.stiffness * spring.point.moved_by(x), spring.arm);
  }
  solve(forces_);
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].change = forces_[i];
  return decrease;
}

template <class Real>
void AttachedBodies<Real>::scale_changes(double share) {
  for (Body& body : bodies_) {
    body.change.shift *= share;
    body.change.turn *= share;
  }
}

template <class Real>
void AttachedBodies<Real>::take_changes() {
  for (Body& body : bodies_) {
    body.move.shift += body.change.shift;
    body.move.turn += body.change.turn;
  }
}

template <class Real>
void AttachedBodies<Real>::solve(std::vector<Screw>& f) const {
  if (joints_.empty()) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) f[i] = bodies_[i].solve(f[i]);
    return;
  }
  std::vector<JoinedBodies::Vector6> all(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) all[i] << f[i].shift, f[i].turn;
  joined_.solve(all);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = {all[i].template head<3>(), all[i].template tail<3>()};
}

template <class Real>
void AttachedBodies<Real>::set_pushes(const std::vector<BodyPush>& pushes) {
  std::vector<Push> next;
  for (const BodyPush& push : pushes) {
    const auto same = std::find_if(pushes_.begin(), pushes_.end(),
                                   [&](const Push& before) { return before.spring.id == push.id; });
    next.push_back({push, same == pushes_.end() ? std::nullopt : same->acts});
  }
  pushes_.swap(next);
}

template <class Real>
double AttachedBodies<Real>::depth(const BodyPush& push) const {
  const Vec3 by_b = push.b ? move(*push.b, push.arm_b) : Vec3(0, 0, 0);
  return push.overlap - push.normal.dot(move(push.a, push.arm_a) - by_b);
}

template <class Real>
void AttachedBodies<Real>::push_apart() {
  joints_.clear();
  for (Push& push : pushes_) {
    const BodyPush& spring = push.spring;
    const double pressed = depth(spring);
    push.acts = push.acts ? pressed > 0 : spring.touches;
    if (!*push.acts) continue;
    const Vec3 force = spring.stiffness * pressed * spring.normal;
    of(spring.a).force.add_force(force, spring.arm_a);
    if (!spring.b) {
      of(spring.a).hold(spring.arm_a, spring.stiffness * spring.normal * spring.normal.transpose());
      continue;
    }
    of(*spring.b).force.add_force(-force, spring.arm_b);
    JoinedBodies::Joint joint{
        static_cast<std::size_t>(spring.a), static_cast<std::size_t>(*spring.b), {}, {}, spring.stiffness};
    joint.on_a << spring.normal, spring.arm_a.cross(spring.normal);
    joint.on_b << spring.normal, spring.arm_b.cross(spring.normal);
    joints_.push_back(joint);
  }
}

template <class Real>
void AttachedBodies<Real>::append_springs(std::vector<OneSidedSpring>& springs) const {
  for (const auto& [push, acts] : pushes_) {
    const Vec3 by_b = push.b ? change(*push.b, push.arm_b) : Vec3(0, 0, 0);
    springs.push_back({depth(push), -push.normal.dot(change(push.a, push.arm_a) - by_b), push.stiffness,
                       acts.value_or(false)});
  }
}

template <class Real>
double AttachedBodies<Real>::misjudged() const {
  double energy = 0;
  for (const auto& [push, acts] : pushes_) {
    const double pressed = depth(push);
    if (acts != (pressed > 0)) energy += push.stiffness * pressed * pressed / 2;
  }
  return energy;
}

template <class Real>
std::vector<double> AttachedBodies<Real>::push_forces() const {
  std::vector<double> forces;
  for (const Push& push : pushes_) {
    const double force = push.spring.stiffness * depth(push.spring);
    forces.push_back(force > 0 ? force : 0);
  }
  return forces;
}

template class AttachedBodies<float>;
template class AttachedBodies<double>;

}  // namespace weft
