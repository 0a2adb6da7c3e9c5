#include "cloth/solver/attached_bodies.h"

#include <Eigen/LU>

namespace weft {
namespace {

/// v x.
Eigen::Matrix3d cross_of(const Vec3& v) {
  return Eigen::Matrix3d{{0, -v.z(), v.y()}, {v.z(), 0, -v.x()}, {-v.y(), v.x(), 0}};
}

}  // namespace

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
}

template <class Real>
void AttachedBodies<Real>::attach(int body, const ClothPoint<Real>& point, const Vec3& arm,
                                  const Eigen::Matrix3d& stiffness, const Vec3& force) {
  const auto index = static_cast<std::size_t>(body);
  Body& hung = bodies_[index];
  const Eigen::Matrix3d lever = cross_of(arm), coupling = -stiffness * lever;
  hung.stiffness += stiffness;
  hung.coupling += coupling;
  hung.turning += lever * coupling;
  hung.force.add_force(-force, arm);
  springs_.push_back({index, point, arm, stiffness});
}

template <class Real>
void AttachedBodies<Real>::eliminate(kernels::Components<Real> b) {
  for (Body& body : bodies_) {
    body.invert();
    body.change = body.solve(body.force);
  }
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
  double product = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Screw change = bodies_[i].solve(sums_[i]);
    product -= sums_[i].dot(change);
    sums_[i] = change;
  }
  for (const Spring& spring : springs_) {
    spring.point.add_force(y, -spring.stiffness * sums_[spring.body].at(spring.arm));
  }
  return product;
}

template <class Real>
double AttachedBodies<Real>::find_changes(kernels::Components<const Real> x) {
  double decrease = 0;
  for (Body& body : bodies_) {
    decrease += body.force.dot(body.solve(body.force)) / 2;
    body.change = body.force;
  }
  for (const Spring& spring : springs_) {
    bodies_[spring.body].change.add_force(spring.stiffness * spring.point.moved_by(x), spring.arm);
  }
  for (Body& body : bodies_) body.change = body.solve(body.change);
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

template class AttachedBodies<float>;
template class AttachedBodies<double>;

}  // namespace weft
