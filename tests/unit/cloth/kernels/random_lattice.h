#pragma once
/// A rumpled sheet with springs of all six families, and the plain list of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "cloth/core/vec3.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/kernels/spring_kernels.h"
#include "cloth/solver/node_arrays.h"

namespace weft::fixture {

/// A spring as the kernels must see it; indices into the grid's arrays.
struct LatticeSpring {
  std::size_t first, second;
  double stiffness, rest_length, limit_length;
  int family;
  bool limited;

  /// Past the limit by so much, m; never of bending springs.
  double past(double length) const { return limited && length > limit_length ? length - limit_length : 0; }
  /// Force on the first end, N, of which d leads from the second.
  Vec3 force(const Vec3& d, double excess) const {
    const double length = d.norm();
    return -stiffness * (length - rest_length + excess * past(length)) / length * d;
  }
  double energy(const Vec3& d, double excess) const {
    const double length = d.norm(), stretch = length - rest_length, over = past(length);
    return stiffness / 2 * (stretch * stretch + excess * over * over);
  }
  /// -dF/dd along the spring, N/m.
  double along(const Vec3& d, double excess) const {
    return stiffness * (past(d.norm()) > 0 ? 1 + excess : 1);
  }
  /// The same across it, never below 0, as the implicit methods have it.
  double across(const Vec3& d, double excess) const {
    const double length = d.norm();
    return stiffness * (std::max(0.0, length - rest_length) + excess * past(length)) / length;
  }
};

/// Families as springs.h counts them: rows and columns from the first end to the second.
inline constexpr std::array<std::array<int, 2>, 6> kLatticeFamilies{
    {{0, 1}, {1, 0}, {1, 1}, {1, -1}, {0, 2}, {2, 0}}};

/// Stiffnesses differ from column to column and, if `torn`, from row to row, where one in five is cut. About
/// half of the springs are stretched, some of them past their limits.
struct RandomLattice {
  explicit RandomLattice(bool torn, int rows = 6, int cols = 21)
      : grid(Grid::with_nodes(rows, cols)), stiffness(grid, 6), vectors(grid, 9) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    springs.has_shear = springs.has_bending = true;
    springs.border_row_share = 0.5;
    springs.excess = 3;
    springs.row_step = torn ? grid.stride : 0;
    const std::array<SpringPlace, 6> families{&springs.along_u, &springs.along_v,   &springs.falling,
                                              &springs.rising,  &springs.bending_u, &springs.bending_v};
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        const std::size_t i = grid.index(r, c);
        position.x[i] = 0.1 * (c + 0.3 * uniform(random));
        position.y[i] = -0.1 * (r + 0.3 * uniform(random));
        position.z[i] = 0.03 * uniform(random);
        change.x[i] = uniform(random);
        change.y[i] = uniform(random);
        change.z[i] = uniform(random);
      }
    }
    for (int f = 0; f < 6; ++f) {
      const auto [down, right] = kLatticeFamilies[static_cast<std::size_t>(f)];
      const double rest = 0.1 * std::hypot(down, right);
      *families[static_cast<std::size_t>(f)] = {stiffness[f], rest, 1.05 * rest};
      for (int r = 0; r < (torn ? grid.rows : 1); ++r) {
        for (int c = 0; c < grid.cols; ++c) {
          const bool inside = c + right >= 0 && c + right < grid.cols && (!torn || r + down < grid.rows);
          const bool cut = torn && uniform(random) > 0.6;
          stiffness[f][grid.index(r, c)] = inside && !cut ? 40 + 20 * uniform(random) : 0;
        }
      }
      list_family(f, down, right, rest, torn);
    }
  }
  RandomLattice(const RandomLattice&) = delete;  // the lattice points into it
  RandomLattice& operator=(const RandomLattice&) = delete;

  static Vec3 difference(const kernels::Components<double>& of, const LatticeSpring& spring) {
    return at<double>(of, spring.first) - at<double>(of, spring.second);
  }

  Grid grid;
  kernels::SpringLattice<double> springs;
  std::vector<LatticeSpring> list;
  NodeArrays<double> stiffness, vectors;
  kernels::Components<double> position = vectors.vector(0), change = vectors.vector(3),
                              force = vectors.vector(6);

 private:
  using SpringPlace = kernels::SpringColumns<double>*;

  void list_family(int f, int down, int right, double rest, bool torn) {
    for (int r = 0; r + down < grid.rows; ++r) {
      for (int c = std::max(0, -right); c < grid.cols - std::max(0, right); ++c) {
        const bool border = down == 0 && (r == 0 || r == grid.rows - 1);
        const double k = stiffness[f][grid.index(torn ? r : 0, c)] * (border ? 0.5 : 1);
        list.push_back({grid.index(r, c), grid.index(r + down, c + right), k, rest, 1.05 * rest, f, f < 4});
      }
    }
  }
};

/// The largest difference of any component of any node from what each node should have.
inline double largest_error(const Grid& grid, const kernels::Components<double>& found,
                            const std::vector<Vec3>& expected) {
  double largest = 0;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const std::size_t i = grid.index(r, c);
      largest = std::max(largest, (at<double>(found, i) - expected[i]).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace weft::fixture
