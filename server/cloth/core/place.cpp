#include "cloth/core/place.h"

#include <cmath>

namespace weft {
namespace {

template <class Real>
bool has_node_near(const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      if (particles.local_position_at(r, c).cwiseAbs().maxCoeff() <= kPlaceGrid) return true;
    }
  }
  return false;
}

/// What lies beside the grid stays 0.
template <class Real>
void shift(Field<Real>& field, double by) {
  const Grid& grid = field.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) field.at(r, c) = static_cast<Real>(double(field.at(r, c)) + by);
  }
}

}  // namespace

Vec3 place_near(const Vec3& point) {
  return point.unaryExpr([](double x) {
    // Added to 0, a negative zero becomes a positive one.
    return std::isfinite(x) ? 0.0 + kPlaceGrid * std::nearbyint(x / kPlaceGrid) : 0.0;
  });
}

template <class Real>
bool follow(Particles<Real>& particles) {
  if (has_node_near(particles)) return false;
  const Grid& grid = particles.grid();
  const Vec3 place = place_near(particles.position_at(grid.rows / 2, grid.cols / 2));
  const Vec3 by = particles.place - place;
  if (by.isZero(0)) return false;
  shift(particles.position.x, by.x());
  shift(particles.position.y, by.y());
  shift(particles.position.z, by.z());
  particles.place = place;
  return true;
}

template bool follow(Particles<float>&);
template bool follow(Particles<double>&);

}  // namespace weft
