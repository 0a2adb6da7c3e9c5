#include "cloth/shapes/mass_properties.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace weft {
namespace {

/// From the mean of x x^T over the mass.
Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moment) {
  return second_moment.trace() * Eigen::Matrix3d::Identity() - second_moment;
}

/// A cylinder of length 2 h and two half balls of radius r, by their volumes, and Steiner's theorem for
/// these, whose own centres are 3/8 r from the flat side.
Eigen::Matrix3d inertia_of(const Capsule& capsule) {
  const double h = capsule.half, r = capsule.radius;
  const double cylinder = 2 * h, ball = 4 * r / 3;  // volumes / (pi r^2)
  const double share = cylinder / (cylinder + ball);
  const double along = share * r * r / 2 + (1 - share) * 2 * r * r / 5;
  const double across =
      share * (r * r / 4 + h * h / 3) + (1 - share) * (2 * r * r / 5 + h * h + 3 * h * r / 4);
  return Vec3(across, along, across).asDiagonal();
}

}  // namespace

MassProperties mass_properties(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return {{0, 0, 0}, 0.4 * sphere->radius * sphere->radius * Eigen::Matrix3d::Identity()};
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vec3 moment = box->half.cwiseAbs2() / 3;
    return {{0, 0, 0}, inertia_of(Eigen::Matrix3d(moment.asDiagonal()))};
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return {{0, 0, 0}, inertia_of(*capsule)};
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mass_properties(mesh->surface->list());
  throw std::invalid_argument("has no end, and so no mass");
}

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
  const Vec3 principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(found.inertia).eigenvalues();
  constexpr double kFlattest = 1e-9;  // of the largest moment
  if (!(volume > 0) || !(principal.minCoeff() > kFlattest * principal.maxCoeff())) {
    throw std::invalid_argument("is too thin to have a mass");
  }
  return found;
}

}  // namespace weft
