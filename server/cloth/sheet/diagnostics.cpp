#include "cloth/sheet/diagnostics.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

/// Adds `of(r, c)` up over all nodes, starting from `sum`.
template <class Sum, class Of>
Sum sum_nodes(const Grid& grid, Sum sum, Of of) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) sum += of(r, c);
  }
  return sum;
}

template <class Real>
bool is_finite(const VectorField<Real>& field) {
  const std::size_t count = field.grid().size();
  return kernels::all_finite(field.x.row(0), count) && kernels::all_finite(field.y.row(0), count) &&
         kernels::all_finite(field.z.row(0), count);
}

}  // namespace

template <class Real>
double total_mass(const Particles<Real>& particles) {
  return sum_nodes(particles.grid(), 0.0, [&](int r, int c) { return double(particles.mass.at(r, c)); });
}

template <class Real>
Vec3 centre_of_mass(const Particles<Real>& particles) {
  const Vec3 sum = sum_nodes(particles.grid(), Vec3(0, 0, 0), [&](int r, int c) -> Vec3 {
    return double(particles.mass.at(r, c)) * particles.position_at(r, c);
  });
  return sum / total_mass(particles);
}

template <class Real>
Vec3 linear_momentum(const Particles<Real>& particles) {
  return sum_nodes(particles.grid(), Vec3(0, 0, 0), [&](int r, int c) -> Vec3 {
    return double(particles.mass.at(r, c)) * particles.velocity_at(r, c);
  });
}

template <class Real>
Vec3 angular_momentum(const Particles<Real>& particles) {
  return sum_nodes(particles.grid(), Vec3(0, 0, 0), [&](int r, int c) -> Vec3 {
    return double(particles.mass.at(r, c)) * particles.position_at(r, c).cross(particles.velocity_at(r, c));
  });
}

template <class Real>
Eigen::Matrix3d inertia_about(const Vec3& point, const Particles<Real>& particles) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  return sum_nodes(particles.grid(), none, [&](int r, int c) -> Eigen::Matrix3d {
    const Vec3 arm = particles.position_at(r, c) - point;
    return double(particles.mass.at(r, c)) *
           (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  });
}

template <class Real>
double kinetic_energy(const Particles<Real>& particles) {
  return sum_nodes(particles.grid(), 0.0, [&](int r, int c) {
    if (particles.inverse_mass.at(r, c) == Real(0)) return 0.0;
    return 0.5 * double(particles.mass.at(r, c)) * particles.velocity_at(r, c).squaredNorm();
  });
}

template <class Real>
double gravitational_energy(const Particles<Real>& particles, const Vec3& acceleration) {
  return -sum_nodes(particles.grid(), 0.0, [&](int r, int c) {
    return double(particles.mass.at(r, c)) * acceleration.dot(particles.position_at(r, c));
  });
}

template <class Real>
bool is_finite(const Particles<Real>& particles) {
  return is_finite(particles.position) && is_finite(particles.velocity);
}

template <class Real>
Vec3 centre(const Particles<Real>& particles) {
  const Vec3 sum = sum_nodes(particles.grid(), Vec3(0, 0, 0),
                             [&](int r, int c) -> Vec3 { return particles.local_position_at(r, c); });
  return particles.place + sum / particles.grid().nodes();
}

template <class Real>
BoundingSphere bounding_sphere(const Particles<Real>& particles) {
  BoundingSphere sphere{centre(particles), 0};
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      sphere.radius = std::max(sphere.radius, (particles.position_at(r, c) - sphere.centre).squaredNorm());
    }
  }
  sphere.radius = std::sqrt(sphere.radius);
  return sphere;
}

template double total_mass<float>(const Particles<float>&);
template double total_mass<double>(const Particles<double>&);
template Vec3 centre_of_mass<float>(const Particles<float>&);
template Vec3 centre_of_mass<double>(const Particles<double>&);
template Vec3 linear_momentum<float>(const Particles<float>&);
template Vec3 linear_momentum<double>(const Particles<double>&);
template Vec3 angular_momentum<float>(const Particles<float>&);
template Vec3 angular_momentum<double>(const Particles<double>&);
template Eigen::Matrix3d inertia_about<float>(const Vec3&, const Particles<float>&);
template Eigen::Matrix3d inertia_about<double>(const Vec3&, const Particles<double>&);
template double kinetic_energy<float>(const Particles<float>&);
template double kinetic_energy<double>(const Particles<double>&);
template double gravitational_energy<float>(const Particles<float>&, const Vec3&);
template double gravitational_energy<double>(const Particles<double>&, const Vec3&);
template bool is_finite<float>(const Particles<float>&);
template bool is_finite<double>(const Particles<double>&);
template Vec3 centre<float>(const Particles<float>&);
template Vec3 centre<double>(const Particles<double>&);
template BoundingSphere bounding_sphere<float>(const Particles<float>&);
template BoundingSphere bounding_sphere<double>(const Particles<double>&);

}  // namespace weft
