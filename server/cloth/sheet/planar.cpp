#include "cloth/sheet/planar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cloth/core/random.h"

namespace weft {
namespace {

/// Compression of an edge, relative, that a sheet in space would have bent away from.
constexpr double kCrumpled = 0.01;

/// All nodes have the same value.
template <class Real>
bool uniform(const Field<Real>& field) {
  const Grid& grid = field.grid();
  const Real first = field.at(0, 0);
  for (int r = 0; r < grid.rows; ++r) {
    const Real* row = field.row(r);
    if (!std::all_of(row, row + grid.cols, [&](Real value) { return value == first; })) return false;
  }
  return true;
}

/// Some edge of a cell is.
template <class Real>
bool crumpled(const Springs<Real>& springs, const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  for (const SpringFamily& family : springs.families()) {
    if (family.rows + std::abs(family.cols) != 1) continue;
    const double shortest = (1 - kCrumpled) * family.rest_length;
    for (int r = 0; r + family.rows < grid.rows; ++r) {
      for (int c = 0; c + family.cols < grid.cols; ++c) {
        const Vec3 edge =
            particles.position_at(r + family.rows, c + family.cols) - particles.position_at(r, c);
        if (edge.squaredNorm() < shortest * shortest && !springs.torn(family, r, c)) return true;
      }
    }
  }
  return false;
}

/// Moves the free nodes at random by what rounding leaves of a coordinate as large as the sheet.
template <class Real>
void scatter(const Springs<Real>& springs, Field<Real>& across, const Field<Real>& inverse_mass) {
  const Grid& grid = across.grid();
  const double size = springs.families().front().rest_length * (grid.rows + grid.cols);
  const double most =
      double(std::numeric_limits<Real>::epsilon()) * (std::abs(double(across.at(0, 0))) + size);
  Random random(0);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double offset = most * random.symmetric();
      if (inverse_mass.at(r, c) == Real(0)) continue;
      across.at(r, c) = static_cast<Real>(double(across.at(r, c)) + offset);
    }
  }
}

}  // namespace

template <class Real>
void leave_plane(const Springs<Real>& springs, Particles<Real>& particles) {
  std::vector<Field<Real>*> flat;
  for (Field<Real>* each : {&particles.position.x, &particles.position.y, &particles.position.z}) {
    if (uniform(*each)) flat.push_back(each);
  }
  constexpr std::size_t kInOnePoint = 3;
  if (flat.empty() || flat.size() == kInOnePoint || !crumpled(springs, particles)) return;
  for (Field<Real>* across : flat) scatter(springs, *across, particles.inverse_mass);
}

template void leave_plane(const Springs<float>&, Particles<float>&);
template void leave_plane(const Springs<double>&, Particles<double>&);

}  // namespace weft
