#include "cloth/kernels/pressure_kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "cloth/core/vec3.h"
#include "flat_sheet.h"

namespace weft::kernels {
namespace {

VectorField<double> pressed(const VectorField<double>& position, double pressure) {
  const Grid& grid = position.grid();
  VectorField<double> force(grid);
  std::vector<double, AlignedAllocator<double>> work(pressure_work_size(grid));
  add_pressure(grid, components(position), pressure, components(force), work.data());
  return force;
}

// p A towards the face, a quarter of each cell to each corner.
TEST(PressureKernels, AFlatSheetIsPushedTowardsItsFace) {
  const Grid grid = Grid::with_nodes(4, 6);
  const VectorField<double> force = pressed(fixture::flat_sheet(grid, 0.1, 0.2), 50);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      EXPECT_NEAR(force.z.at(r, c), 50 * 0.02 / 4 * fixture::cells_at(grid, r, c), 1e-14);
      EXPECT_EQ(force.x.at(r, c), 0);
      EXPECT_EQ(force.y.at(r, c), 0);
    }
  }
}

/// Between the origin and the triangles: a x b . c / 6 each, the mean of the two ways to cut the cell.
double volume(const VectorField<double>& position) {
  const auto at = [&](int r, int c) {
    return Vec3(position.x.at(r, c), position.y.at(r, c), position.z.at(r, c));
  };
  const auto cone = [](const Vec3& a, const Vec3& b, const Vec3& c) { return a.cross(b).dot(c) / 6; };
  const Vec3 a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
  return (cone(a, b, c) + cone(a, c, d) + cone(a, b, d) + cone(b, c, d)) / 2;
}

// p dV/dr of a warped cell. A triangle p, q, s gives p a third of its area vector, (p x q + q x s + s x p) /
// 6, of which q x s / 6 is the derivative of its volume to the origin. The rest adds up to that of the cell's
// rim, which cells next to it would take back.
TEST(PressureKernels, AWarpedCellsForceIsTheVolumesDerivative) {
  const Grid grid = Grid::with_nodes(2, 2);
  VectorField<double> position = fixture::flat_sheet(grid, 0.3, 0.2);
  position.z.at(0, 0) = 0.1;
  position.z.at(1, 1) = 0.15;
  position.x.at(1, 0) = -0.05;
  constexpr double kPressure = 20, kChange = 1e-6;
  const VectorField<double> force = pressed(position, kPressure);
  Vec3 sum(0, 0, 0);
  for (const int r : {0, 1}) {
    for (const int c : {0, 1}) {
      Field<double>* axes[] = {&position.x, &position.y, &position.z};
      Vec3 slope;
      for (int axis = 0; axis < 3; ++axis) {
        double& value = axes[axis]->at(r, c);
        const double before = value;
        value = before + kChange;
        const double more = volume(position);
        value = before - kChange;
        slope[axis] = kPressure * (more - volume(position)) / (2 * kChange);
        value = before;
      }
      // Round the rim against the clock: (0, 0), (1, 0), (1, 1), (0, 1).
      const int place = r == 0 ? (c == 0 ? 0 : 3) : (c == 0 ? 1 : 2);
      const auto corner = [&](int k) {
        const int row = (k % 4 == 1 || k % 4 == 2) ? 1 : 0, col = k % 4 >= 2 ? 1 : 0;
        return Vec3(position.x.at(row, col), position.y.at(row, col), position.z.at(row, col));
      };
      const Vec3 own(force.x.at(r, c), force.y.at(r, c), force.z.at(r, c));
      const Vec3 rim = corner(place).cross(corner(place + 1)) + corner(place + 3).cross(corner(place));
      EXPECT_LT((own - (slope + kPressure / 6 * rim)).norm(), 1e-7) << r << c;
      sum += own;
    }
  }
  // All forces together are p times the cell's area vector, half the cross product of its diagonals.
  const Vec3 down(position.x.at(1, 1) - position.x.at(0, 0), position.y.at(1, 1) - position.y.at(0, 0),
                  position.z.at(1, 1) - position.z.at(0, 0));
  const Vec3 up(position.x.at(0, 1) - position.x.at(1, 0), position.y.at(0, 1) - position.y.at(1, 0),
                position.z.at(0, 1) - position.z.at(1, 0));
  EXPECT_LT((sum - kPressure / 2 * down.cross(up)).norm(), 1e-12);
}

}  // namespace
}  // namespace weft::kernels
