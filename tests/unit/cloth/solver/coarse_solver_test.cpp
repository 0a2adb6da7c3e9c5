#include "cloth/solver/coarse_solver.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "cloth/core/vec3.h"
#include "cloth/solver/grid_level.h"

namespace weft {
namespace {

template <class Real>
class CoarseSolverOf : public testing::Test {};
using CoarseSolverReals = testing::Types<float, double>;
TYPED_TEST_SUITE(CoarseSolverOf, CoarseSolverReals);

// Two nodes i and j of diagonal d that a link K joins: their sum is (b_i + b_j) / d, their difference
// (d + 2 K)^-1 (b_i - b_j). Others have b / d, fixed ones 0.
TYPED_TEST(CoarseSolverOf, ALinkSharesWhatPullsApart) {
  using Real = TypeParam;
  const double tolerance = std::is_same_v<Real, float> ? 1e-6 : 1e-14;
  const Grid grid = Grid::with_nodes(3, 3);
  GridLevel<Real, kernels::Blocks<Real>> level(grid, false, nullptr);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const std::size_t node = grid.index(r, c);
      level.diagonal()[node] = 2;
      level.free()[node] = r == 2 && c == 2 ? Real(0) : Real(1);
      level.b.x[node] = 4;
    }
  }
  const std::size_t i = grid.index(0, 0), j = grid.index(0, 1);
  Eigen::Matrix3d link;
  link << 3, 1, 0, 1, 4, -1, 0, -1, 5;
  const kernels::Blocks<Real>& to = level.matrix.links.along_u;
  to.xx[i] = 3;
  to.xy[i] = 1;
  to.yy[i] = 4;
  to.yz[i] = -1;
  to.zz[i] = 5;
  const Vec3 pull_i(1, 2, 3), pull_j(-2, 0, 7);
  for (const auto& [node, pull] : {std::pair(i, pull_i), std::pair(j, pull_j)}) {
    level.b.x[node] = static_cast<Real>(pull.x());
    level.b.y[node] = static_cast<Real>(pull.y());
    level.b.z[node] = static_cast<Real>(pull.z());
  }
  CoarseSolver<Real> solver(grid, nullptr);
  solver.factorise(level.matrix, nullptr);
  solver.solve(level.b, level.x);
  const auto found = [&](std::size_t node) {
    return Vec3(double(level.x.x[node]), double(level.x.y[node]), double(level.x.z[node]));
  };
  const Eigen::Matrix3d apart = 2 * Eigen::Matrix3d::Identity() + 2 * link;
  EXPECT_LT((found(i) + found(j) - (pull_i + pull_j) / 2).norm(), tolerance);
  EXPECT_LT((found(i) - found(j) - apart.inverse() * (pull_i - pull_j)).norm(), tolerance);
  EXPECT_NEAR(found(grid.index(1, 1)).x(), 2, tolerance);
  EXPECT_EQ(found(grid.index(2, 2)).norm(), 0);
}

}  // namespace
}  // namespace weft
