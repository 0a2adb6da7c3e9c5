#include "cloth/kernels/transfer_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cloth/core/random.h"
#include "cloth/solver/node_arrays.h"

namespace weft::kernels {
namespace {

const Grid kFineGrid = Grid::with_nodes(9, 17), kCoarseGrid = Grid::with_nodes(5, 9);

class TransferKernels : public testing::Test {
 protected:
  void SetUp() override { std::fill_n(free_[0], kFineGrid.size(), 1.0); }

  double* restricted() {
    restrict_sum<double>(kFineGrid, fine_[0], kCoarseGrid, coarse_[0], {0, kCoarseGrid.rows}, work_.data());
    return coarse_[0];
  }
  double* prolonged() {
    prolong_add<double>(kCoarseGrid, coarse_[0], kFineGrid, free_[0], fine_[0], {0, kFineGrid.rows},
                        work_.data());
    return fine_[0];
  }
  template <class Value>
  static void fill(NodeArrays<double>& to, const Grid& grid, const Value& value) {
    for (int r = 0; r < grid.rows; ++r)
      for (int c = 0; c < grid.cols; ++c) to[0][grid.index(r, c)] = value(r, c);
  }

  NodeArrays<double> fine_{kFineGrid, 1}, free_{kFineGrid, 1}, coarse_{kCoarseGrid, 1};
  std::vector<double, AlignedAllocator<double>> work_ = std::vector<double, AlignedAllocator<double>>(
      static_cast<std::size_t>(kFineGrid.stride + 2 * kRowAlign));
};

// A node takes 1 of itself, 1/2 of each neighbour and 1/4 of each node across a cell: of ones 4 within, 3 on
// a side and 9/4 at a corner.
TEST_F(TransferKernels, RestrictionAddsUpWeights) {
  fill(fine_, kFineGrid, [](int, int) { return 1.0; });
  const double* sums = restricted();
  EXPECT_DOUBLE_EQ(sums[kCoarseGrid.index(2, 4)], 4);
  EXPECT_DOUBLE_EQ(sums[kCoarseGrid.index(0, 4)], 3);
  EXPECT_DOUBLE_EQ(sums[kCoarseGrid.index(2, 8)], 3);
  EXPECT_DOUBLE_EQ(sums[kCoarseGrid.index(0, 0)], 2.25);
  EXPECT_DOUBLE_EQ(sums[kCoarseGrid.index(4, 8)], 2.25);
}

// Bilinear interpolation gives a bilinear function exactly.
TEST_F(TransferKernels, ProlongationKeepsBilinearFunctions) {
  const auto value = [](double r, double c) { return 1 + 2 * r - 3 * c + 0.5 * r * c; };
  fill(coarse_, kCoarseGrid, [&](int r, int c) { return value(2 * r, 2 * c); });
  const double* found = prolonged();
  for (int r = 0; r < kFineGrid.rows; ++r)
    for (int c = 0; c < kFineGrid.cols; ++c) EXPECT_NEAR(found[kFineGrid.index(r, c)], value(r, c), 1e-12);
}

TEST_F(TransferKernels, ProlongationLeavesFixedNodes) {
  fill(coarse_, kCoarseGrid, [](int, int) { return 1.0; });
  fill(fine_, kFineGrid, [](int, int) { return 5.0; });
  free_[0][kFineGrid.index(3, 7)] = 0;
  const double* found = prolonged();
  EXPECT_EQ(found[kFineGrid.index(3, 7)], 5);
  EXPECT_EQ(found[kFineGrid.index(3, 8)], 6);
}

// <P c, f> = <c, P^T f>.
TEST_F(TransferKernels, AreEachOthersTranspose) {
  Random random(1);
  NodeArrays<double> f(kFineGrid, 1), c(kCoarseGrid, 1);
  fill(f, kFineGrid, [&](int, int) { return random.symmetric(); });
  fill(c, kCoarseGrid, [&](int, int) { return random.symmetric(); });
  std::copy_n(f[0], kFineGrid.size(), fine_[0]);
  const double* sums = restricted();
  double down = 0, up = 0;
  for (std::size_t i = 0; i < kCoarseGrid.size(); ++i) down += c[0][i] * sums[i];
  std::fill_n(fine_[0], kFineGrid.size(), 0.0);
  std::copy_n(c[0], kCoarseGrid.size(), coarse_[0]);
  const double* between = prolonged();
  for (std::size_t i = 0; i < kFineGrid.size(); ++i) up += f[0][i] * between[i];
  EXPECT_NEAR(up, down, 1e-12);
  EXPECT_GT(std::abs(up), 1e-3);
}

}  // namespace
}  // namespace weft::kernels
