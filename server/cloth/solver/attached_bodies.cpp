#include "cloth/solver/attached_bodies.h"

#include <Eigen/LU>

#include "cloth/solver/node_vector.h"

namespace weft {
template <class Real>
void AttachedBodies<Real>::clear() {
  bodies_.clear();
  springs_.clear();
}

template <class Real>
int AttachedBodies<Real>::add(double inertia) {
  bodies_.push_back({inertia});
  return static_cast<int>(bodies_.size()) - 1;
}

template <class Real>
void AttachedBodies<Real>::reset() {
  for (Body& body : bodies_) body.move.setZero();
}

template <class Real>
void AttachedBodies<Real>::detach() {
  springs_.clear();
  for (Body& body : bodies_) {
    body.stiffness.setZero();
    body.force = -body.inertia * body.move;
  }
}

template <class Real>
void AttachedBodies<Real>::attach(int body, std::size_t node, const Eigen::Matrix3d& stiffness,
                                  const Vec3& force) {
  const auto index = static_cast<std::size_t>(body);
  bodies_[index].stiffness += stiffness;
  bodies_[index].force -= force;
  springs_.push_back({index, node, stiffness});
}

template <class Real>
void AttachedBodies<Real>::eliminate(kernels::Components<Real> b) {
  for (Body& body : bodies_) {
    body.inverse = (body.inertia * Eigen::Matrix3d::Identity() + body.stiffness).inverse();
    body.change = body.inverse * body.force;
  }
  for (const Spring& spring : springs_) {
    weft::add(b, spring.node, spring.stiffness * bodies_[spring.body].change);
  }
}

template <class Real>
double AttachedBodies<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const {
  sums_.assign(bodies_.size(), Vec3::Zero());
  for (const Spring& spring : springs_) sums_[spring.body] += spring.stiffness * at(x, spring.node);
  double product = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vec3 change = bodies_[i].inverse * sums_[i];
    product -= sums_[i].dot(change);
    sums_[i] = change;
  }
  for (const Spring& spring : springs_) {
    weft::add(y, spring.node, -spring.stiffness * sums_[spring.body]);
  }
  return product;
}

template <class Real>
double AttachedBodies<Real>::find_changes(kernels::Components<const Real> x) {
  double decrease = 0;
  for (Body& body : bodies_) {
    decrease += body.force.dot(body.inverse * body.force) / 2;
    body.change = body.force;
  }
  for (const Spring& spring : springs_) {
    bodies_[spring.body].change += spring.stiffness * at(x, spring.node);
  }
  for (Body& body : bodies_) body.change = body.inverse * body.change;
  return decrease;
}

template <class Real>
void AttachedBodies<Real>::scale_changes(double share) {
  for (Body& body : bodies_) body.change *= share;
}

template <class Real>
void AttachedBodies<Real>::take_changes() {
  for (Body& body : bodies_) body.move += body.change;
}

template class AttachedBodies<float>;
template class AttachedBodies<double>;

}  // namespace weft
