// inflation: p dV/dr on every node.
#include <gtest/gtest.h>

#include "cloth/forces/inflation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

constexpr double kPressure = 300;

/// Volume between the sheet and the origin: of each cell the mean of its two pairs of triangles, each the
/// base of a tetrahedron.
double volume(const VectorField<double>& at) {
  const auto tetrahedron = [](const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) / 6; };
  double sum = 0;
  for (int r = 0; r + 1 < at.grid().rows; ++r) {
    for (int c = 0; c + 1 < at.grid().cols; ++c) {
      const Vec3 upper_left = get(at, r, c), lower_left = get(at, r + 1, c);
      const Vec3 lower_right = get(at, r + 1, c + 1), upper_right = get(at, r, c + 1);
      sum += (tetrahedron(upper_left, lower_left, lower_right) +
              tetrahedron(upper_left, lower_right, upper_right) +
              tetrahedron(upper_left, lower_left, upper_right) +
              tetrahedron(lower_left, lower_right, upper_right)) /
             2;
    }
  }
  return sum;
}

template <class Real>
VectorField<Real> push(const Particles<Real>& sheet) {
  VectorField<Real> force(sheet.grid());
  Inflation<Real>({kPressure}).add_forces(sheet, {}, force);
  return force;
}

template <class Real>
Particles<Real> crumpled_sheet(int rows, int cols) {
  Particles<Real> sheet(Grid::with_nodes(rows, cols));
  test::randomise(sheet.position, -1, 1, 3);
  return sheet;
}

TEST(Inflation, PushesAFlatSheetToItsFaceByItsArea) {
  // 2 m x 1 m in 6 x 4 cells: p A in all, a cell's worth on a node inside, half on the rim, a quarter in a
  // corner.
  const VectorField<double> force = push(test::flat_sheet<double>(5, 7, {2, 1}));
  const double cell = kPressure * 2.0 / 24;
  Vec3 total = Vec3::Zero();
  each_node(force.grid(), [&](int r, int c) {
    const double share = (r == 0 || r == 4 ? 0.5 : 1) * (c == 0 || c == 6 ? 0.5 : 1);
    EXPECT_NEAR((get(force, r, c) - Vec3(0, 0, cell * share)).norm(), 0, 1e-12 * cell);
    total += get(force, r, c);
  });
  EXPECT_NEAR((total - Vec3(0, 0, kPressure * 2)).norm(), 0, 1e-10);
}

TEST(Inflation, IsThePressureTimesTheVolumesGradient) {
  // The volume is linear in each coordinate: central differences have rounding alone, 1e-15 / 1e-3. On the
  // rim the volume depends on the origin.
  const double step = 1e-3;
  const Particles<double> sheet = crumpled_sheet<double>(6, 9);
  const VectorField<double> force = push(sheet);
  VectorField<double> moved = sheet.position;
  for (int r = 1; r < 5; ++r) {
    for (int c = 1; c < 8; ++c) {
      const Vec3 here = get(moved, r, c);
      Vec3 gradient;
      for (int axis = 0; axis < 3; ++axis) {
        set(moved, r, c, here + step * Vec3::Unit(axis));
        const double more = volume(moved);
        set(moved, r, c, here - step * Vec3::Unit(axis));
        gradient[axis] = (more - volume(moved)) / (2 * step);
      }
      set(moved, r, c, here);
      EXPECT_LT((get(force, r, c) - kPressure * gradient).norm(), 1e-9) << r << ", " << c;
    }
  }
}

TEST(Inflation, OnAClosedSheetAddsUpToNothing) {
  // All of the rim in one point: a bag. No net force, no net torque.
  Particles<double> bag = crumpled_sheet<double>(7, 7);
  each_node(bag.grid(), [&](int r, int c) {
    if (r == 0 || c == 0 || r == 6 || c == 6) set(bag.position, r, c, Vec3(0.3, -0.2, 0.1));
  });
  const VectorField<double> force = push(bag);
  Vec3 total = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  each_node(bag.grid(), [&](int r, int c) {
    total += get(force, r, c);
    torque += get(bag.position, r, c).cross(get(force, r, c));
    size = std::max(size, get(force, r, c).norm());
  });
  EXPECT_LT(total.norm(), 1e-13 * size);
  EXPECT_LT(torque.norm(), 1e-13 * size);
  EXPECT_GT(size, 10);
}

TEST(Inflation, IsTheSameInSinglePrecision) {
  const VectorField<double> exact = push(crumpled_sheet<double>(9, 34));
  // Sums of 24 products of numbers up to 2 m, times p / 12.
  EXPECT_LT(test::largest_difference(push(crumpled_sheet<float>(9, 34)), exact), 1e-6 * kPressure * 24);
}

}  // namespace
}  // namespace weft
