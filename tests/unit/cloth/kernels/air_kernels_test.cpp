#include "cloth/kernels/air_kernels.h"

#include <gtest/gtest.h>

#include <limits>

#include "cloth/core/vec3.h"
#include "cloth/solver/node_arrays.h"
#include "flat_sheet.h"

namespace weft::kernels {
namespace {

constexpr double kWidth = 0.5, kHeight = 0.25, kArea = kWidth * kHeight;
constexpr double kAnyFlow = std::numeric_limits<double>::infinity();
const Grid kAirGrid = Grid::with_nodes(3, 4);

class AirKernels : public testing::Test {
 protected:
  VectorField<double> force(const Uniform<double>& air, const Plate<double>& plate,
                            double most_flow = kAnyFlow) {
    VectorField<double> sum(kAirGrid);
    add_air_force<double>(kAirGrid, components(position_), components(velocity_), air, plate, most_flow,
                          components(sum));
    return sum;
  }

  VectorField<double> position_ = fixture::flat_sheet(kAirGrid, kWidth, kHeight);
  VectorField<double> velocity_{kAirGrid};
};

// Square on a plate the force is 1/2 rho C_L v^2 A along the wind; each corner has a quarter of its cells'.
TEST_F(AirKernels, SquareOnTheForceGrowsWithTheSquareOfTheWind) {
  const VectorField<double> sum = force({0, 0, -3}, {0.6, 0});
  for (int r = 0; r < kAirGrid.rows; ++r) {
    for (int c = 0; c < kAirGrid.cols; ++c) {
      EXPECT_NEAR(sum.z.at(r, c), -0.6 * 9 * kArea / 4 * fixture::cells_at(kAirGrid, r, c), 1e-14);
      EXPECT_NEAR(sum.x.at(r, c), 0, 1e-15);
    }
  }
}

// At 45 degrees w.A = |w| A / sqrt 2: along the normal `normal` |w|^2 A / 2, and along the wind `along`
// |w|^2 A / 2^1.5, of a node inside.
TEST_F(AirKernels, AslantTheTwoPartsFollowTheirAngles) {
  const double side = 2, speed_squared = 2 * side * side;
  const VectorField<double> sum = force({side, 0, side}, {0.6, 0.2});
  const double normal = 0.6 * speed_squared * kArea / 2;
  const double along = 0.2 * speed_squared * kArea / (2 * std::sqrt(2.0));
  EXPECT_NEAR(sum.z.at(1, 1), normal + along / std::sqrt(2.0), 1e-13);
  EXPECT_NEAR(sum.x.at(1, 1), along / std::sqrt(2.0), 1e-13);
}

TEST_F(AirKernels, OnlyTheRelativeWindCounts) {
  velocity_.z.fill(-3);
  EXPECT_EQ(force({0, 0, -3}, {0.6, 0.2}).z.at(1, 1), 0);
  EXPECT_NEAR(force({0, 0, 0}, {0.6, 0}).z.at(1, 1), 0.6 * 9 * kArea, 1e-14);
}

// Beyond most_flow the first |w.A| is most_flow: the force grows with w.A itself.
TEST_F(AirKernels, AStrongFlowCountsOnceOnly) {
  const double most_flow = kArea;  // that of 1 m/s
  EXPECT_NEAR(force({0, 0, 1}, {0.6, 0}, most_flow).z.at(1, 1), 0.6 * kArea, 1e-15);
  EXPECT_NEAR(force({0, 0, 5}, {0.6, 0}, most_flow).z.at(1, 1), 0.6 * 5 * kArea, 1e-14);
}

TEST_F(AirKernels, AirMayDifferFromNodeToNode) {
  VectorField<float> air(kAirGrid);
  air.z.fill(-3);
  const VectorField<double> same = force({0, 0, -3}, {0.6, 0.2});
  VectorField<double> sum(kAirGrid);
  add_air_force<double>(kAirGrid, components(position_), components(velocity_),
                        Components<const float>(components(air)), {0.6, 0.2}, kAnyFlow, components(sum));
  for (int c = 0; c < kAirGrid.cols; ++c) EXPECT_NEAR(sum.z.at(1, c), same.z.at(1, c), 1e-14);
}

TEST_F(AirKernels, FindTheLargestFlow) {
  velocity_.z.at(2, 3) = 4;  // its cell's mean: 1 m/s
  EXPECT_NEAR((max_air_flow<double>(kAirGrid, components(position_), components(velocity_),
                                    Uniform<double>{1, 0, -2})),
              3 * kArea, 1e-15);
}

// Of a face 2 normal |w.A| n n^T, a quarter to each corner.
TEST_F(AirKernels, DampingIsTheForcesDerivative) {
  NodeArrays<double> damping(kAirGrid, 6);
  const Blocks<double> blocks = damping.blocks();
  add_air_damping<double>(kAirGrid, components(position_), components(velocity_), Uniform<double>{0, 0, -3},
                          {0.6, 0}, blocks);
  EXPECT_NEAR(blocks.zz[kAirGrid.index(1, 1)], 2 * 0.6 * 3 * kArea, 1e-14);
  EXPECT_NEAR(blocks.zz[kAirGrid.index(0, 0)], 2 * 0.6 * 3 * kArea / 4, 1e-14);
  EXPECT_EQ(blocks.xx[kAirGrid.index(1, 1)], 0);
  // The same by a difference quotient: all corners move, so the sum over a face is meant.
  constexpr double kChange = 1e-6;
  const double before = force({0, 0, -3}, {0.6, 0}).z.at(1, 1);
  velocity_.z.fill(kChange);
  const double slope = (before - force({0, 0, -3}, {0.6, 0}).z.at(1, 1)) / kChange;
  EXPECT_NEAR(slope, blocks.zz[kAirGrid.index(1, 1)], 1e-6);
}

}  // namespace
}  // namespace weft::kernels
