#include "cloth/sheet/start.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "cloth/core/place.h"
#include "cloth/core/random.h"

namespace weft {
namespace {

/// Calls visit(r, c, u, v) for every node, row by row, (u, v) its place on the sheet.
template <class Visit>
void for_each_node(const Grid& grid, Visit visit) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      visit(r, c, static_cast<double>(c) / (grid.cols - 1), static_cast<double>(r) / (grid.rows - 1));
    }
  }
}

template <class Real>
void set(VectorField<Real>& field, int r, int c, const Vec3& value) {
  field.x.at(r, c) = static_cast<Real>(value.x());
  field.y.at(r, c) = static_cast<Real>(value.y());
  field.z.at(r, c) = static_cast<Real>(value.z());
}

/// Where the node at (u, v) of a cloth that is not sewn starts, as the cloth lies in its own x-y plane, m.
Vec3 flat(const Vec2& size, double u, double v) { return {(u - 0.5) * size.x(), (0.5 - v) * size.y(), 0.0}; }

/// The same of a bag: its two sides lie on each other, opened by a hundredth of their shorter edge, which
/// stretches them by less than 0.05 %.
Vec3 folded(const Vec2& size, double u, double v) {
  constexpr double kOpening = 0.005, kPi = std::numbers::pi;
  const double width = size.x() / 2;
  return {2 * width * (std::min(u, 1 - u) - 0.25), (0.5 - v) * size.y(),
          kOpening * std::min(width, size.y()) * std::sin(2 * kPi * u) * std::sin(kPi * v)};
}

}  // namespace

template <class Real>
Particles<Real> start(const ClothDescription& description, int level) {
  Particles<Real> particles(description.base_cells.at(level));
  const Grid& grid = particles.grid();
  const std::vector<Vec3>& nodes = description.nodes;
  if (!nodes.empty() && nodes.size() != static_cast<std::size_t>(grid.nodes())) {
    throw std::invalid_argument("a cloth needs as many start positions as it has nodes at its initial level");
  }
  const auto own_place = description.sewn ? folded : flat;
  const auto middle = static_cast<std::size_t>(grid.rows / 2) * static_cast<std::size_t>(grid.cols) +
                      static_cast<std::size_t>(grid.cols / 2);
  particles.place = place_near(nodes.empty() ? description.position : nodes[middle]);
  std::size_t next = 0;
  for_each_node(grid, [&](int r, int c, double u, double v) {
    const auto on_the_sheet = [&] {
      return Vec3(description.position + description.orientation * own_place(description.size, u, v));
    };
    set(particles.position, r, c, (nodes.empty() ? on_the_sheet() : nodes[next++]) - particles.place);
    set(particles.velocity, r, c, description.velocity);
  });
  return particles;
}

template <class Real>
void perturb(const ClothDescription& description, std::uint64_t seed, Particles<Real>& particles) {
  if (description.perturbation == 0) return;
  Random random(seed);
  const Vec3 normal = description.orientation * Vec3(0, 0, 1);
  for_each_node(particles.grid(), [&](int r, int c, double, double) {
    const double offset = description.perturbation * random.symmetric();
    if (particles.inverse_mass.at(r, c) > Real(0)) {
      set(particles.position, r, c, particles.local_position_at(r, c) + offset * normal);
    }
  });
}

template Particles<float> start(const ClothDescription&, int);
template Particles<double> start(const ClothDescription&, int);
template void perturb(const ClothDescription&, std::uint64_t, Particles<float>&);
template void perturb(const ClothDescription&, std::uint64_t, Particles<double>&);

}  // namespace weft
