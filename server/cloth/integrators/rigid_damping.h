#pragma once
#include <Eigen/Core>
#include <array>

#include "cloth/integrators/forces.h"

namespace weft {

/// How a scene's effects resist a cloth that moves as a rigid body.
template <class Real>
class RigidDamping {
 public:
  /// Symmetric, positive semidefinite: times a rigid motion, the velocity of `centre`, m/s, and the spin,
  /// rad/s, the force, N, and the torque about `centre`, m in the world, N m, against it, by what the effects
  /// add to an implicit system, but for `other`: their dampings, and their stiffnesses, which resist what the
  /// motion leads to in `h`, s (Effect::add_damping, add_stiffness).
  Eigen::Matrix<double, 6, 6> matrix(const Particles<Real>& particles, const Forces<Real>& forces,
                                     const Vec3& centre, double h, const Effect<Real>* other);

 private:
  // Of each node, N s/m; work space.
  Field<Real> scalar_, stiffness_;  // that of springs, N/m
  std::array<Field<Real>, 6> blocks_;
};

extern template class RigidDamping<float>;
extern template class RigidDamping<double>;

}  // namespace weft
