#include "cloth/sheet/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/core/small_system.h"
#include "cloth/kernels/components.h"
#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"

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

/// Calls visit(row, column) for every other one.
template <class Real, class Visit>
void for_each_held(const Particles<Real>& particles, Visit visit) {
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    const Real* inverse_mass = particles.inverse_mass.row(r);
    for (int c = 0; c < grid.cols; ++c) {
      if (inverse_mass[c] == Real(0)) visit(r, c);
    }
  }
}

struct RigidMotion {
  bool still = true;       ///< all of it is 0
  Vec3 centre{0, 0, 0};    ///< of mass, m
  Vec3 velocity{0, 0, 0};  ///< of the centre, m/s
  Vec3 spin{0, 0, 0};      ///< rad/s
  Vec3 at(const Vec3& position) const { return velocity + spin.cross(position - centre); }
};

/// The free one that has its part of the momentum and angular momentum of nodes of these velocities.
template <class Real>
RigidMotion rigid_motion(const Particles<Real>& particles, kernels::Components<const Real> velocity,
                         const Freedom& freedom) {
  RigidMotion motion;
  if (freedom.is_none()) return motion;
  motion.still = false;
  motion.centre = centre_of_mass(particles);
  for_each_free(particles,
                [&](std::size_t i, double m, const Vec3&) { motion.velocity += m * at<Real>(velocity, i); });
  motion.velocity /= total_mass(particles);
  Vec3 angular_momentum(0, 0, 0);
  for_each_free(particles, [&](std::size_t i, double m, const Vec3& position) {
    angular_momentum += m * (position - motion.centre).cross(at<Real>(velocity, i));
  });
  const Eigen::Matrix3d inertia = inertia_about(motion.centre, particles);
  if (freedom.is_all()) {
    // Nodes in one line do not turn about it.
    motion.spin = least_solution(inertia, angular_momentum);
    return motion;
  }
  const double mass = total_mass(particles);
  Freedom::Screw momentum;
  momentum << mass * motion.velocity, angular_momentum;
  const Freedom::Screw free = freedom.motion(momentum, mass, inertia);
  motion.velocity = free.head<3>();
  motion.spin = free.tail<3>();
  return motion;
}

/// Of the nodes' motion, J.
template <class Real>
double energy_beside(const RigidMotion& rigid, const Particles<Real>& particles) {
  const auto velocity = kernels::components(particles.velocity);
  const Grid& grid = particles.grid();
  double energy = 0;
  if (rigid.still) {
    energy = kernels::weighted_square<Real>(particles.mass.row(0), velocity, grid) / 2;
    for_each_held(particles, [&](int r, int c) {
      energy -= double(particles.mass.at(r, c)) * particles.velocity_at(r, c).squaredNorm() / 2;
    });
    return energy;
  }
  for_each_free(particles, [&](std::size_t i, double m, const Vec3& position) {
    energy += m * (at<Real>(velocity, i) - rigid.at(position)).squaredNorm() / 2;
  });
  return energy;
}

template <class Real>
void scale_about(const RigidMotion& rigid, const Particles<Real>& particles, double factor,
                 VectorField<Real>& velocity) {
  const auto v = kernels::components(velocity);
  if (rigid.still) {
    const Real* inverse_mass = particles.inverse_mass.row(0);
    for (Real* component : {v.x, v.y, v.z}) {
      for (std::size_t i = 0; i < particles.grid().size(); ++i) {
        component[i] *= inverse_mass[i] > Real(0) ? static_cast<Real>(factor) : Real(1);
      }
    }
    return;
  }
  for_each_free(particles, [&](std::size_t i, double, const Vec3& position) {
    const Vec3 kept = rigid.at(position);
    set(v, i, Vec3(kept + factor * (at<Real>(v, i) - kept)));
  });
}

}  // namespace

template <class Real>
bool is_held(const Particles<Real>& particles) {
  bool held = false;
  for_each_held(particles, [&](int, int) { held = true; });
  return held;
}

template <class Real>
MotionEnergy motion_energy(const Particles<Real>& particles, const Freedom& freedom) {
  const auto velocity = kernels::components(particles.velocity);
  RigidMotion rigid = rigid_motion(particles, velocity, freedom);
  const double inner = energy_beside(rigid, particles);
  if (rigid.still) return {inner, inner};
  if (!freedom.is_all()) return {energy_beside(RigidMotion{}, particles), inner};
  rigid.spin.setZero();
  return {energy_beside(rigid, particles), inner};
}

template <class Real>
double work_beside_centre(const Particles<Real>& particles, const VectorField<Real>& force,
                          const VectorField<Real>& way, bool held) {
  const auto forces = kernels::components(force), ways = kernels::components(way);
  if (held) return kernels::dot<Real>(forces, ways, particles.grid());
  double work = 0, mass = 0;
  Vec3 sum(0, 0, 0), moved(0, 0, 0);
  for_each_free(particles, [&](std::size_t i, double m, const Vec3&) {
    const Vec3 f = at<Real>(forces, i), s = at<Real>(ways, i);
    work += f.dot(s);
    sum += f;
    moved += m * s;
    mass += m;
  });
  return work - sum.dot(moved) / mass;
}

template <class Real>
void accelerate(Particles<Real>& particles, const VectorField<Real>& force, double seconds) {
  kernels::add_weighted(kernels::components(particles.velocity), kernels::components(force),
                        particles.inverse_mass.row(0), static_cast<Real>(seconds), particles.grid().size());
}

template <class Real>
double add_to_motion(Particles<Real>& particles, double energy, const Freedom& freedom) {
  if (!(std::abs(energy) > 0)) return 1;
  const RigidMotion rigid =
      rigid_motion(particles, kernels::components(std::as_const(particles.velocity)), freedom);
  const double motion = energy_beside(rigid, particles);
  if (motion == 0) return 1;
  const double factor = std::sqrt(std::max(0.0, 1 + energy / motion));
  scale_about(rigid, particles, factor, particles.velocity);
  return factor;
}

template <class Real>
double take_from_motion(Particles<Real>& particles, double energy, const Freedom& freedom) {
  return energy > 0 ? add_to_motion(particles, -energy, freedom) : 1;
}

template <class Real>
void scale_motion(const Particles<Real>& particles, double factor, VectorField<Real>& velocity,
                  const Freedom& freedom) {
  scale_about(rigid_motion(particles, kernels::components(std::as_const(velocity)), freedom), particles,
              factor, velocity);
}

template bool is_held(const Particles<float>&);
template bool is_held(const Particles<double>&);
template MotionEnergy motion_energy(const Particles<float>&, const Freedom&);
template MotionEnergy motion_energy(const Particles<double>&, const Freedom&);
template double work_beside_centre(const Particles<float>&, const VectorField<float>&,
                                   const VectorField<float>&, bool);
template double work_beside_centre(const Particles<double>&, const VectorField<double>&,
                                   const VectorField<double>&, bool);
template void accelerate(Particles<float>&, const VectorField<float>&, double);
template void accelerate(Particles<double>&, const VectorField<double>&, double);
template double add_to_motion(Particles<float>&, double, const Freedom&);
template double add_to_motion(Particles<double>&, double, const Freedom&);
template double take_from_motion(Particles<float>&, double, const Freedom&);
template double take_from_motion(Particles<double>&, double, const Freedom&);
template void scale_motion(const Particles<float>&, double, VectorField<float>&, const Freedom&);
template void scale_motion(const Particles<double>&, double, VectorField<double>&, const Freedom&);

}  // namespace weft
