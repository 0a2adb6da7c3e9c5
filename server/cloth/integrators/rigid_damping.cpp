#include "cloth/integrators/rigid_damping.h"

namespace weft {

template <class Real>
Eigen::Matrix<double, 6, 6> RigidDamping<Real>::matrix(const Particles<Real>& particles,
                                                       const Forces<Real>& forces, const Vec3& centre,
                                                       double h, const Effect<Real>* other) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  if (!(forces.max_damping_rates(particles, other).sum() > 0)) return sum;
  const Grid& grid = particles.grid();
  if (scalar_.grid() != grid) {
    scalar_ = stiffness_ = Field<Real>(grid);
    blocks_.fill(Field<Real>(grid));
  } else {
    scalar_.fill(0);
    stiffness_.fill(0);
    for (Field<Real>& block : blocks_) block.fill(0);
  }
  auto& [xx, xy, xz, yy, yz, zz] = blocks_;
  for (const auto& effect : *forces.effects) {
    if (effect.get() == other) continue;
    effect->add_damping(particles, forces.context,
                        {scalar_.row(0), {xx.row(0), xy.row(0), xz.row(0), yy.row(0), yz.row(0), zz.row(0)}});
  }
  for (const auto& effect : *forces.effects) {
    if (effect.get() != other) effect->add_stiffness(particles, forces.context, stiffness_.row(0));
  }
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const auto entry = [&](const Field<Real>& field) { return double(field.at(r, c)); };
      Eigen::Matrix3d damping;
      damping << entry(xx), entry(xy), entry(xz), entry(xy), entry(yy), entry(yz), entry(xz), entry(yz),
          entry(zz);
      damping.diagonal().array() += entry(scalar_) + h * entry(stiffness_);
      const Vec3 arm = particles.position_at(r, c) - centre;
      Eigen::Matrix3d turned, levered;  // arm x damping, and that x arm
      for (int k = 0; k < 3; ++k) turned.col(k) = arm.cross(Vec3(damping.col(k)));
      for (int k = 0; k < 3; ++k) levered.row(k) = arm.cross(Vec3(turned.row(k))).transpose();
      sum.template topLeftCorner<3, 3>() += damping;
      sum.template bottomLeftCorner<3, 3>() += turned;
      sum.template bottomRightCorner<3, 3>() += levered;
    }
  }
  sum.template topRightCorner<3, 3>() = sum.template bottomLeftCorner<3, 3>().transpose();
  return sum;
}

template class RigidDamping<float>;
template class RigidDamping<double>;

}  // namespace weft
