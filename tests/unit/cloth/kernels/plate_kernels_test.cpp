#include "cloth/kernels/plate_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cloth/solver/node_arrays.h"

namespace weft::kernels {
namespace {

const Grid kPlateGrid = Grid::with_nodes(5, 7);

class PlateKernels : public testing::Test {
 protected:
  void SetUp() override { std::fill_n(free_, kPlateGrid.size(), 1.0); }

  /// x = value of row and column, in all three components.
  template <class Value>
  void bend(const Value& value) {
    for (int r = 0; r < kPlateGrid.rows; ++r)
      for (int c = 0; c < kPlateGrid.cols; ++c)
        for (double* component : {x_.x, x_.y, x_.z}) component[kPlateGrid.index(r, c)] = value(r, c);
  }
  double add() {
    return add_plate<double>({u_, v_, twist_}, kPlateGrid, x_, free_, y_, {0, kPlateGrid.rows}, work_.data());
  }

  NodeArrays<double> numbers_{kPlateGrid, 10};
  double *u_ = numbers_[0], *v_ = numbers_[1], *twist_ = numbers_[2], *free_ = numbers_[3];
  Components<double> x_ = numbers_.vector(4), y_ = numbers_.vector(7);
  std::vector<double, AlignedAllocator<double>> work_ =
      std::vector<double, AlignedAllocator<double>>(plate_work_size(kPlateGrid));
};

// x = c^2 has the second difference 2 along u: k a a^T x = 2 k (1, -2, 1), and x . K x = 4 k a component.
TEST_F(PlateKernels, OneStencilAlongARow) {
  bend([](int, int c) { return double(c * c); });
  u_[kPlateGrid.index(2, 3)] = 5;
  EXPECT_NEAR(add(), 3 * 4 * 5, 1e-12);
  EXPECT_EQ(y_.x[kPlateGrid.index(2, 2)], 10);
  EXPECT_EQ(y_.y[kPlateGrid.index(2, 3)], -20);
  EXPECT_EQ(y_.z[kPlateGrid.index(2, 4)], 10);
  EXPECT_EQ(y_.x[kPlateGrid.index(1, 3)], 0);
}

TEST_F(PlateKernels, OneStencilAlongAColumn) {
  bend([](int r, int) { return double(r * r); });
  v_[kPlateGrid.index(2, 3)] = 5;
  EXPECT_NEAR(add(), 3 * 4 * 5, 1e-12);
  EXPECT_EQ(y_.x[kPlateGrid.index(1, 3)], 10);
  EXPECT_EQ(y_.y[kPlateGrid.index(2, 3)], -20);
  EXPECT_EQ(y_.z[kPlateGrid.index(3, 3)], 10);
}

// x = r c has the mixed difference 1: (1, -1, -1, 1) k.
TEST_F(PlateKernels, OneStencilOfTwist) {
  bend([](int r, int c) { return double(r * c); });
  twist_[kPlateGrid.index(1, 2)] = 7;
  EXPECT_NEAR(add(), 3 * 7, 1e-12);
  EXPECT_EQ(y_.x[kPlateGrid.index(1, 2)], 7);
  EXPECT_EQ(y_.x[kPlateGrid.index(1, 3)], -7);
  EXPECT_EQ(y_.x[kPlateGrid.index(2, 2)], -7);
  EXPECT_EQ(y_.x[kPlateGrid.index(2, 3)], 7);
}

TEST_F(PlateKernels, WhatIsPlaneIsNotBent) {
  bend([](int r, int c) { return 3 + 2.0 * r - c; });
  for (int r = 0; r < kPlateGrid.rows; ++r) {
    for (int c = 0; c < kPlateGrid.cols; ++c) {
      if (c > 0 && c + 1 < kPlateGrid.cols) u_[kPlateGrid.index(r, c)] = 5;
      if (r > 0 && r + 1 < kPlateGrid.rows) v_[kPlateGrid.index(r, c)] = 6;
      if (r + 1 < kPlateGrid.rows && c + 1 < kPlateGrid.cols) twist_[kPlateGrid.index(r, c)] = 7;
    }
  }
  EXPECT_EQ(add(), 0);
  for (std::size_t i = 0; i < kPlateGrid.size(); ++i) EXPECT_EQ(y_.x[i], 0);
}

TEST_F(PlateKernels, FixedNodesTakeNothingAndSubtractingTakesAllBack) {
  bend([](int r, int c) { return double(c * c - r * c); });
  u_[kPlateGrid.index(2, 3)] = 5;
  twist_[kPlateGrid.index(2, 2)] = 7;
  free_[kPlateGrid.index(2, 3)] = 0;
  add();
  EXPECT_EQ(y_.x[kPlateGrid.index(2, 3)], 0);
  EXPECT_NE(y_.x[kPlateGrid.index(2, 2)], 0);
  subtract_plate<double>({u_, v_, twist_}, kPlateGrid, x_, free_, y_, {0, kPlateGrid.rows}, work_.data());
  for (std::size_t i = 0; i < kPlateGrid.size(); ++i) EXPECT_EQ(y_.x[i], 0);
}

}  // namespace
}  // namespace weft::kernels
