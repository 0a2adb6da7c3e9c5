#include "cloth/kernels/plate_projection_kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "cloth/solver/node_arrays.h"

namespace weft::kernels {
namespace {

// One stencil (1, -2, 1) along a row whose middle is off by 0.1 m: C = -0.2. With nodes of 1 kg and k h^2 =
// 0.5 kg it is projected by C / (1 + 4 + 1 + 2) = -0.025: the ends move by 0.025 m and the middle by -0.05 m.
TEST(PlateProjection, OneStencilIsProjectedByItsCompliance) {
  const Grid grid = Grid::with_nodes(5, 7);
  const QuarterRows layout(grid);
  NodeArrays<double> stencils(grid, 3);
  stencils[0][grid.index(2, 3)] = 50;
  Field<double> inverse_mass(grid);
  inverse_mass.fill(1);
  VectorField<double> force(grid), velocity(grid), position(grid), rounded_off(grid);
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.cols; ++c) position.x.at(r, c) = c;
  position.z.at(2, 3) = 0.1;
  using Numbers = std::vector<double, AlignedAllocator<double>>;
  Numbers lanes(plate_lanes_size(layout)), sheet(layout.size()), row(static_cast<std::size_t>(grid.stride));
  const XpbdNodes<double> nodes{components(force), inverse_mass.row(0), components(velocity),
                                components(position), components(rounded_off)};
  constexpr double kTenth = 0.1;  // s
  set_plate_lanes(layout, grid, {stencils[0], stencils[1], stencils[2]}, kTenth * kTenth, lanes.data());
  set_inverse_masses(layout, grid, inverse_mass.row(0), sheet.data());
  predict(layout, grid, nodes, 0.0, kTenth, sheet.data(), row.data());
  project_plate(layout, lanes.data(), sheet.data());
  take_over(layout, grid, sheet.data(), kTenth, nodes, row.data());
  EXPECT_NEAR(position.z.at(2, 2), 0.025, 1e-14);
  EXPECT_NEAR(position.z.at(2, 3), 0.05, 1e-14);
  EXPECT_NEAR(position.z.at(2, 4), 0.025, 1e-14);
  EXPECT_NEAR(position.x.at(2, 3), 3, 1e-14);
  EXPECT_EQ(position.z.at(1, 3), 0);
}

}  // namespace
}  // namespace weft::kernels
