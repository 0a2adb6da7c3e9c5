#include "cloth/levels/lift_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/levels/chord.h"

namespace weft {
namespace {

/// Ways out of one solid after another, of solids that overlap.
constexpr int kRounds = 4;
/// A sum of normals shorter than this says no direction: the nodes around lie on opposite sides.
constexpr double kOpposite = 1e-6;

/// Across the sheet of the coarser level where a new node lies; unit, or 0 where the cell has no area.
template <class Real>
Vec3 across_sheet(const Particles<Real>& particles, int row, int col, int stride) {
  const Grid& grid = particles.grid();
  const int top = std::min(row - row % stride, grid.rows - 1 - stride),
            left = std::min(col - col % stride, grid.cols - 1 - stride);
  const auto place = [&](int down, int right) {
    return particles.local_position_at(top + down * stride, left + right * stride);
  };
  return (place(1, 1) - place(0, 0)).cross(place(1, 0) - place(0, 1)).normalized();
}

/// How the nodes look at a solid between which a new one lies.
struct Around {
  double distance = 0;    ///< from the surface, in the mean, m
  std::vector<Vec3> out;  ///< the ways that they look: the mean, if there is one, and each one's
};

template <class Real>
Around around(const Particles<Real>& particles, int row, int col, int stride, const PlacedShape& shape) {
  Around all;
  Vec3 mean(0, 0, 0), place(0, 0, 0);
  bool opposite = false;
  for_each_around(row, col, stride, [&](int r, int c, double weight) {
    const Vec3 at = particles.local_position_at(r, c);
    const Surface near = shape.surface(at);
    all.distance += weight * near.distance;
    mean += weight * near.normal;
    place += weight * at;
    opposite = opposite || std::any_of(all.out.begin(), all.out.end(),
                                       [&](const Vec3& other) { return other.dot(near.normal) < 0; });
    all.out.push_back(near.normal);
  });
  if (opposite) {  // the sheet goes around the solid between them
    const Vec3 across = across_sheet(particles, row, col, stride);
    all.out = {across.dot(place - shape.centre) < 0 ? Vec3(-across) : across};
  } else if (mean.norm() > kOpposite) {
    all.out.insert(all.out.begin(), mean.normalized());
  }
  return all;
}

/// Where a new node at `place`, inside, belongs: out by the shortest of the ways that they look. At a corner
/// their mean may look along the solid.
Vec3 lifted(const Vec3& place, const Around& nodes, const PlacedShape& shape) {
  double shortest = std::numeric_limits<double>::infinity();
  Vec3 out(0, 0, 0);
  for (const Vec3& along : nodes.out) {
    const double way = shape.way_out(place, along);
    if (!(way < shortest)) continue;
    shortest = way;
    out = along;
  }
  const double way = shortest + std::min(nodes.distance, 0.0);
  return std::isfinite(way) && way > 0 ? Vec3(place + way * out) : place;
}

/// Lifts new nodes that are `of` these inverse masses, where deeper than `shallow`, m. From split to split:
/// those of the next one follow what the nodes around them were lifted by.
template <class Real, class Of>
bool lift(int splits, const std::vector<Solid>& solids, double shallow, Particles<Real>& particles, Of of) {
  std::vector<PlacedShape> shapes;
  shapes.reserve(solids.size());
  for (const Solid& solid : solids) shapes.push_back(solid.placed(0));
  const Particles<Real> before = particles;
  bool any = false;
  const auto lift_node = [&](int row, int col, int stride) {
    Vec3 place = before.local_position_at(row, col);
    if (any) {
      for_each_around(row, col, stride, [&](int r, int c, double weight) {
        place += weight * (particles.local_position_at(r, c) - before.local_position_at(r, c));
      });
    }
    for (int round = 0; round < kRounds; ++round) {
      const Vec3 came = place;
      for (const PlacedShape& shape : shapes) {
        if (!shape.contains(place) || -shape.surface(place).distance <= shallow) continue;
        place = lifted(place, around(particles, row, col, stride, shape), shape);
      }
      if (place == came) break;
    }
    particles.position.x.at(row, col) = static_cast<Real>(place.x());
    particles.position.y.at(row, col) = static_cast<Real>(place.y());
    particles.position.z.at(row, col) = static_cast<Real>(place.z());
    any = any || particles.local_position_at(row, col) != before.local_position_at(row, col);
  };
  const Grid& grid = particles.grid();
  for (int stride = 1 << splits; stride > 1; stride /= 2) {
    for (int row = 0; row < grid.rows; row += stride / 2) {
      for (int col = 0; col < grid.cols; col += stride / 2) {
        const bool is_new = row % stride != 0 || col % stride != 0;
        if (is_new && of(particles.inverse_mass.at(row, col))) lift_node(row, col, stride);
      }
    }
  }
  return any;
}

}  // namespace

template <class Real>
bool lift_new_pins(int splits, const std::vector<Solid>& solids, Particles<Real>& particles) {
  return lift(splits, solids, 0, particles, [](Real inverse_mass) { return inverse_mass == Real(0); });
}

template <class Real>
bool lift_new_free_nodes(int splits, const std::vector<Solid>& solids, double shallow,
                         Particles<Real>& particles) {
  return lift(splits, solids, shallow, particles, [](Real inverse_mass) { return inverse_mass > Real(0); });
}

template bool lift_new_pins(int, const std::vector<Solid>&, Particles<float>&);
template bool lift_new_pins(int, const std::vector<Solid>&, Particles<double>&);
template bool lift_new_free_nodes(int, const std::vector<Solid>&, double, Particles<float>&);
template bool lift_new_free_nodes(int, const std::vector<Solid>&, double, Particles<double>&);

}  // namespace weft
