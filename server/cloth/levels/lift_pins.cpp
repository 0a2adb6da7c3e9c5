#include "cloth/levels/lift_pins.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// Ways out of one solid after another, of solids that overlap.
constexpr int kRounds = 4;
/// A sum of normals shorter than this says no direction: the nodes around lie on opposite sides.
constexpr double kOpposite = 1e-6;

/// The surface next to the nodes of the coarser level between which a node lies: the means of their distances
/// and normals, weighted as Eq. 8 weights the nodes, whose rows and columns are `stride` apart.
template <class Real>
Surface surface_around(const Particles<Real>& particles, int row, int col, int stride,
                       const PlacedShape& shape) {
  Surface mean{0, Vec3(0, 0, 0)};
  const int top = row - row % stride, left = col - col % stride;
  for (const int r : {top, top + stride}) {
    for (const int c : {left, left + stride}) {
      const double weight =
          (1 - std::abs(row - r) / double(stride)) * (1 - std::abs(col - c) / double(stride));
      if (weight == 0) continue;
      const Surface near = shape.surface(particles.local_position_at(r, c));
      mean.distance += weight * near.distance;
      mean.normal += weight * near.normal;
    }
  }
  return mean;
}

/// Where a new node at `place`, inside, belongs, as seen by the nodes around it.
Vec3 lifted(const Vec3& place, const Surface& around, const PlacedShape& shape) {
  const double length = around.normal.norm();
  const Vec3 out = length > kOpposite ? Vec3(around.normal / length) : shape.surface(place).normal;
  const double way = shape.way_out(place, out) + std::min(around.distance, 0.0);
  return std::isfinite(way) && way > 0 ? Vec3(place + way * out) : place;
}

}  // namespace

template <class Real>
bool lift_new_pins(int splits, const std::vector<Solid>& solids, Particles<Real>& particles) {
  const int stride = 1 << splits;
  std::vector<PlacedShape> shapes;
  shapes.reserve(solids.size());
  for (const Solid& solid : solids) shapes.push_back(solid.placed(0));
  bool any = false;
  const auto lift = [&](int row, int col) {
    const Vec3 before = particles.local_position_at(row, col);
    Vec3 place = before;
    for (int round = 0; round < kRounds; ++round) {
      const Vec3 came = place;
      for (const PlacedShape& shape : shapes) {
        if (!shape.contains(place)) continue;
        place = lifted(place, surface_around(particles, row, col, stride, shape), shape);
      }
      if (place == came) break;
    }
    particles.position.x.at(row, col) = static_cast<Real>(place.x());
    particles.position.y.at(row, col) = static_cast<Real>(place.y());
    particles.position.z.at(row, col) = static_cast<Real>(place.z());
    any = any || particles.local_position_at(row, col) != before;
  };
  for (int row = 0; row < particles.grid().rows; ++row) {
    for (int col = 0; col < particles.grid().cols; ++col) {
      const bool is_new = row % stride != 0 || col % stride != 0;
      if (is_new && particles.inverse_mass.at(row, col) == Real(0)) lift(row, col);
    }
  }
  return any;
}

template bool lift_new_pins(int, const std::vector<Solid>&, Particles<float>&);
template bool lift_new_pins(int, const std::vector<Solid>&, Particles<double>&);

}  // namespace weft
