#include "cloth/shapes/mass_properties.h"

#include <stdexcept>

#include "cloth/core/small_system.h"

namespace weft {

Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moment) {
  return second_moment.trace() * Eigen::Matrix3d::Identity() - second_moment;
}

Vec3 principal_moments(const Eigen::Matrix3d& inertia) { return spectrum_of(inertia).values; }

MassProperties mass_properties(const TriangleList& surface) {
  // From a corner: from far away the tetrahedra would cancel.
  const Vec3 origin = surface.vertices.at(0);
  double volume = 0;                                 // 6 times, m3
  Vec3 first(0, 0, 0);                               // 24 times, m4
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // 120 times, m5
  for (const std::array<int, 3>& triangle : surface.triangles) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) {
      corners.col(i) =
          surface.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])] - origin;
    }
    const double part = corners.determinant();
    const Vec3 sum = corners.rowwise().sum();
    volume += part;
    first += part * sum;
    second += part * (corners * corners.transpose() + sum * sum.transpose());
  }
  const Vec3 centre = first / (4 * volume);
  MassProperties found{origin + centre,
                       inertia_of(Eigen::Matrix3d(second / (20 * volume) - centre * centre.transpose()))};
  const Vec3 principal = principal_moments(found.inertia);
  constexpr double kFlattest = 1e-9;  // of the largest moment
  if (!(volume > 0) || !(principal.minCoeff() > kFlattest * principal.maxCoeff())) {
    throw std::invalid_argument("is too thin to have a mass");
  }
  return found;
}

}  // namespace weft
