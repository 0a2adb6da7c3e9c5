#pragma once
/// What the cloth's tests share: small sheets, random states, and a plain list of the springs a sheet must
/// have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <random>
#include <vector>

#include "cloth/core/description.h"
#include "cloth/core/particles.h"
#include "cloth/levels/refine.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// Names it in the tests' output.
inline std::ostream& operator<<(std::ostream& out, Discretization discretization) {
  return out << (discretization == Discretization::paper ? "paper" : "continuum");
}

}  // namespace weft

namespace weft::test {

/// The ordinary step, in s.
inline constexpr double kFrame = 1.0 / 60;

/// One node of a vector field, in double.
template <class Real>
Vec3 get(const VectorField<Real>& field, int r, int c) {
  return {double(field.x.at(r, c)), double(field.y.at(r, c)), double(field.z.at(r, c))};
}

template <class Real>
void set(VectorField<Real>& field, int r, int c, const Vec3& value) {
  field.x.at(r, c) = static_cast<Real>(value.x());
  field.y.at(r, c) = static_cast<Real>(value.y());
  field.z.at(r, c) = static_cast<Real>(value.z());
}

/// Calls `visit(row, col)` for every node, row by row.
inline void each_node(const Grid& grid, const std::function<void(int, int)>& visit) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) visit(r, c);
  }
}

/// Every component of every node uniform in [low, high]; the same seed gives the same values.
template <class Real>
void randomise(VectorField<Real>& field, double low, double high, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(low, high);
  each_node(field.grid(), [&](int r, int c) {
    const double x = value(random), y = value(random), z = value(random);
    set(field, r, c, {x, y, z});
  });
}

/// A flat sheet in the x-y plane, centred, u along +x, v along -y; every node free, mass 1 kg, at rest.
template <class Real>
Particles<Real> flat_sheet(int rows, int cols, const Vec2& size) {
  Particles<Real> sheet(Grid::with_nodes(rows, cols));
  each_node(sheet.grid(), [&](int r, int c) {
    const double u = double(c) / (cols - 1), v = double(r) / (rows - 1);
    set(sheet.position, r, c, {(u - 0.5) * size.x(), (0.5 - v) * size.y(), 0.0});
    sheet.mass.at(r, c) = Real(1);
    sheet.inverse_mass.at(r, c) = Real(1);
  });
  return sheet;
}

/// Gives every node its share of `total` kg, and frees it.
template <class Real>
void share_mass(Particles<Real>& particles, double total, Discretization discretization) {
  mass_distribution(total, discretization, particles.mass);
  each_node(particles.grid(),
            [&](int r, int c) { particles.inverse_mass.at(r, c) = Real(1) / particles.mass.at(r, c); });
}

inline Material stiffnesses(double structural, double shear, double bending) {
  Material material;
  material.structural = structural;
  material.shear = shear;
  material.bending = bending;
  return material;
}

/// A spring of a sheet, written out.
struct ListedSpring {
  int r0, c0, r1, c1;
  double rest_length, stiffness;
};

/// Every spring of `families` on `grid`, found by the plainest loop: the list that the stencil kernels must
/// agree with.
inline std::vector<ListedSpring> list_springs(const std::vector<SpringFamily>& families, const Grid& grid) {
  std::vector<ListedSpring> springs;
  for (const SpringFamily& family : families) {
    each_node(grid, [&](int r, int c) {
      const int r1 = r + family.rows, c1 = c + family.cols;
      if (r1 < 0 || r1 >= grid.rows || c1 < 0 || c1 >= grid.cols) return;
      const bool on_border_row = family.rows == 0 && (r == 0 || r == grid.rows - 1);
      const bool on_border_col = family.cols == 0 && (c == 0 || c == grid.cols - 1);
      const double share = on_border_row || on_border_col ? family.border_share : 1.0;
      springs.push_back({r, c, r1, c1, family.rest_length, share * family.stiffness});
    });
  }
  return springs;
}

/// The largest difference of any component of any node.
template <class A, class B>
double largest_difference(const VectorField<A>& a, const VectorField<B>& b) {
  double largest = 0;
  each_node(a.grid(), [&](int r, int c) {
    largest = std::max(largest, (get(a, r, c) - get(b, r, c)).cwiseAbs().maxCoeff());
  });
  return largest;
}

/// True if every node of the two has the same bits (padding is nobody's business).
template <class Real>
bool same_bits(const VectorField<Real>& a, const VectorField<Real>& b) {
  bool same = a.grid() == b.grid();
  if (same) {
    each_node(a.grid(), [&](int r, int c) { same = same && get(a, r, c) == get(b, r, c); });
  }
  return same;
}

template <class Real>
bool same_state(const Particles<Real>& a, const Particles<Real>& b) {
  return same_bits(a.position, b.position) && same_bits(a.velocity, b.velocity) &&
         same_bits(a.acceleration, b.acceleration);
}

/// Inner forces change neither momentum nor angular momentum: their sums are zero to what rounding leaves of
/// a hundred nodes or so.
inline void expect_no_net_force(const VectorField<double>& position, const VectorField<double>& force) {
  Vec3 total = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  each_node(position.grid(), [&](int r, int c) {
    total += get(force, r, c);
    torque += get(position, r, c).cross(get(force, r, c));
    size = std::max(size, get(force, r, c).norm());
  });
  EXPECT_GT(size, 0);
  EXPECT_LT(total.norm(), 1e-13 * size);
  EXPECT_LT(torque.norm(), 1e-13 * size);
}

/// Sum of the masses of a sheet, correctly rounded: a running sum with its rounding error kept (Neumaier).
template <class Real>
double exact_sum(const Field<Real>& field) {
  double sum = 0, lost = 0;
  each_node(field.grid(), [&](int r, int c) {
    const double value = double(field.at(r, c)), next = sum + value;
    lost += std::abs(sum) >= std::abs(value) ? (sum - next) + value : (value - next) + sum;
    sum = next;
  });
  return sum + lost;
}

}  // namespace weft::test
