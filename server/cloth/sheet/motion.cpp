#include "cloth/sheet/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/kernels/components.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Calls visit(index, mass, position) for every free node.
template <class Real, class Visit>
void for_each_free(const Particles<Real>& particles, Visit visit) {
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      if (particles.inverse_mass.at(r, c) > Real(0))
        visit(grid.index(r, c), double(particles.mass.at(r, c)), particles.position_at(r, c));
    }
  }
}

template <class Real>
bool is_held(const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      if (particles.inverse_mass.at(r, c) == Real(0)) return true;
    }
  }
  return false;
}

struct RigidMotion {
  Vec3 centre{0, 0, 0};    ///< of mass, m
  Vec3 velocity{0, 0, 0};  ///< of the centre, m/s
  Vec3 spin{0, 0, 0};      ///< rad/s
  Vec3 at(const Vec3& position) const { return velocity + spin.cross(position - centre); }
};

/// The one with the momentum and angular momentum of nodes of these velocities; none where a node is held.
template <class Real>
RigidMotion rigid_motion(const Particles<Real>& particles, kernels::Components<const Real> velocity) {
  RigidMotion motion;
  if (is_held(particles)) return motion;
  double mass = 0;
  for_each_free(particles, [&](std::size_t i, double m, const Vec3& position) {
    mass += m;
    motion.centre += m * position;
    motion.velocity += m * at<Real>(velocity, i);
  });
  motion.centre /= mass;
  motion.velocity /= mass;
  Vec3 angular_momentum(0, 0, 0);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for_each_free(particles, [&](std::size_t i, double m, const Vec3& position) {
    const Vec3 arm = position - motion.centre;
    angular_momentum += m * arm.cross(at<Real>(velocity, i));
    inertia += m * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  });
  // Nodes in one line do not turn about it.
  motion.spin = inertia.completeOrthogonalDecomposition().solve(angular_momentum);
  return motion;
}

template <class Real>
void scale_about(const RigidMotion& rigid, const Particles<Real>& particles, double factor,
                 VectorField<Real>& velocity) {
  const auto v = kernels::components(velocity);
  for_each_free(particles, [&](std::size_t i, double, const Vec3& position) {
    const Vec3 kept = rigid.at(position);
    set(v, i, Vec3(kept + factor * (at<Real>(v, i) - kept)));
  });
}

}  // namespace

template <class Real>
double take_from_motion(Particles<Real>& particles, double energy) {
  if (!(energy > 0)) return 1;
  const auto velocity = kernels::components(std::as_const(particles.velocity));
  const RigidMotion rigid = rigid_motion(particles, velocity);
  double motion = 0;  // J
  for_each_free(particles, [&](std::size_t i, double m, const Vec3& position) {
    motion += m * (at<Real>(velocity, i) - rigid.at(position)).squaredNorm() / 2;
  });
  if (motion == 0) return 1;
  const double factor = std::sqrt(std::max(0.0, 1 - energy / motion));
  scale_about(rigid, particles, factor, particles.velocity);
  return factor;
}

template <class Real>
void scale_motion(const Particles<Real>& particles, double factor, VectorField<Real>& velocity) {
  scale_about(rigid_motion(particles, kernels::components(std::as_const(velocity))), particles, factor,
              velocity);
}

template double take_from_motion(Particles<float>&, double);
template double take_from_motion(Particles<double>&, double);
template void scale_motion(const Particles<float>&, double, VectorField<float>&);
template void scale_motion(const Particles<double>&, double, VectorField<double>&);

}  // namespace weft
