#include "cloth/kernels/push_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/kernels/components.h"
#include "cloth/kernels/uniform.h"
#include "flat_sheet.h"

namespace weft::kernels {
namespace {

const Grid kPushGrid = Grid::with_nodes(3, 5);
constexpr Push<double> kPush{0.5, 2};

/// Of 0.1 kg, 0.2 kg and so on along a row.
Field<double> masses() {
  Field<double> mass(kPushGrid);
  for (int r = 0; r < kPushGrid.rows; ++r)
    for (int c = 0; c < kPushGrid.cols; ++c) mass.at(r, c) = 0.1 * (c + 1);
  return mass;
}

TEST(PushKernels, ANodeIsPushedByItsShareAndItsMass) {
  const Field<double> mass = masses();
  VectorField<double> force(kPushGrid);
  add_push<double>(kPushGrid, mass.row(0), kPush, Uniform<double>{3, 0, -4}, components(force));
  for (int c = 0; c < kPushGrid.cols; ++c) {
    const double strength = 0.5 + 2 * 0.1 * (c + 1);
    EXPECT_NEAR(force.x.at(1, c), 3 * strength, 1e-14);
    EXPECT_NEAR(force.z.at(2, c), -4 * strength, 1e-14);
  }
}

// Whichever way the normal points it is turned downwind, and only the wind's direction counts.
TEST(PushKernels, AlongNormalsTheSheetIsPushedDownwind) {
  const Field<double> mass = masses();
  VectorField<double> position = fixture::flat_sheet(kPushGrid, 0.1, 0.2);
  for (const double side : {-1.0, 1.0}) {
    VectorField<double> force(kPushGrid);
    const double slant = std::sqrt(0.5);
    add_push_along_normals<double>(kPushGrid, components(position), mass.row(0), kPush,
                                   Uniform<double>{slant, 0, side * slant}, components(force));
    for (int r = 0; r < kPushGrid.rows; ++r) {
      for (int c = 0; c < kPushGrid.cols; ++c) {
        EXPECT_NEAR(force.z.at(r, c), side * (0.5 + 2 * 0.1 * (c + 1)), 1e-14);
        EXPECT_NEAR(force.x.at(r, c), 0, 1e-15);
      }
    }
  }
}

// Of each node's own wind the speed counts, too.
TEST(PushKernels, AlongNormalsANodesOwnWindHasItsSpeed) {
  const Field<double> mass = masses();
  VectorField<double> position = fixture::flat_sheet(kPushGrid, 0.1, 0.2), force(kPushGrid);
  VectorField<float> wind(kPushGrid);
  wind.x.at(1, 2) = 3;
  wind.z.at(1, 2) = -4;  // 5 m/s
  add_push_along_normals<double>(kPushGrid, components(position), mass.row(0), kPush,
                                 Components<const float>(components(wind)), components(force));
  EXPECT_NEAR(force.z.at(1, 2), -5 * (0.5 + 2 * 0.3), 1e-14);
  EXPECT_EQ(force.z.at(1, 3), 0);
}

TEST(PushKernels, WhereNeighboursSpanNoSurfaceThereIsNone) {
  const Field<double> mass = masses();
  const VectorField<double> heap(kPushGrid);  // all in one place
  VectorField<double> force(kPushGrid);
  add_push_along_normals<double>(kPushGrid, components(heap), mass.row(0), kPush, Uniform<double>{0, 0, 1},
                                 components(force));
  for (int c = 0; c < kPushGrid.cols; ++c) EXPECT_EQ(force.z.at(1, c), 0);
}

}  // namespace
}  // namespace weft::kernels
