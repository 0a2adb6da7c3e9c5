#include "cloth/solver/coarse_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <random>
#include <type_traits>
#include <utility>

#include "cloth/core/vec3.h"
#include "cloth/sheet/plate.h"
#include "cloth/sheet/seam.h"
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

/// A grid's matrix of random numbers, node (0, 1) fixed unless the grid is sewn, and the same as one dense
/// matrix with the identity for what is fixed.
struct RandomMatrix {
  Grid grid = Grid::with_nodes(5, 5);
  GridLevel<double, kernels::Blocks<double>> level{grid, false, nullptr};
  Eigen::MatrixXd dense;
  Eigen::VectorXd b;

  /// The row of the node's first component.
  static Eigen::Index row(int r, int c) { return Eigen::Index{3} * (r * 5 + c); }

  RandomMatrix(std::uint64_t seed, bool sewn) : dense(Eigen::MatrixXd::Zero(75, 75)), b(75) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto is_free = [&](int r, int c) { return sewn || r != 0 || c != 1; };
    for (int r = 0; r < 5; ++r) {
      for (int c = 0; c < 5; ++c) {
        const std::size_t i = grid.index(r, c);
        level.free()[i] = is_free(r, c) ? 1 : 0;
        level.diagonal()[i] = 1.5 + number(random);
        dense.block<3, 3>(row(r, c), row(r, c)).diagonal().array() += is_free(r, c) ? level.diagonal()[i] : 1;
        for (Eigen::Index k = 0; k < 3; ++k) b[row(r, c) + k] = number(random);
        level.b.x[i] = b[row(r, c)];
        level.b.y[i] = b[row(r, c) + 1];
        level.b.z[i] = b[row(r, c) + 2];
        if (!is_free(r, c)) b.segment<3>(row(r, c)).setZero();
        const auto join = [&](const kernels::Blocks<double>& links, int rows, int cols) {
          if (r + rows > 4 || c + cols > 4 || c + cols < 0) return;
          const Eigen::Matrix3d any = Eigen::Matrix3d::NullaryExpr([&] { return number(random); });
          const Eigen::Matrix3d link = any * any.transpose();
          links.xx[i] = link(0, 0);
          links.xy[i] = link(0, 1);
          links.xz[i] = link(0, 2);
          links.yy[i] = link(1, 1);
          links.yz[i] = link(1, 2);
          links.zz[i] = link(2, 2);
          const Eigen::Index one = row(r, c), two = row(r + rows, c + cols);
          const bool free_one = is_free(r, c), free_two = is_free(r + rows, c + cols);
          if (free_one) dense.block<3, 3>(one, one) += link;
          if (free_two) dense.block<3, 3>(two, two) += link;
          if (!free_one || !free_two) return;
          dense.block<3, 3>(one, two) -= link;
          dense.block<3, 3>(two, one) -= link;
        };
        join(level.matrix.links.along_u, 0, 1);
        join(level.matrix.links.along_v, 1, 0);
        join(level.matrix.links.falling, 1, 1);
        join(level.matrix.links.rising, 1, -1);
      }
    }
  }
  /// Of the solver's x and that of the dense system with every seam's two nodes as one, the largest
  /// difference.
  double difference(const Seam<double>* seam) const {
    Eigen::MatrixXd joins = Eigen::MatrixXd::Identity(75, 75);
    if (seam != nullptr) {
      for (const auto& [left, right] : seam->pairs()) {
        const auto row_of = [&](std::size_t node) {
          return row(static_cast<int>(node) / grid.stride, static_cast<int>(node) % grid.stride);
        };
        joins.block<3, 3>(row_of(right), row_of(right)).setZero();
        joins.block<3, 3>(row_of(right), row_of(left)).setIdentity();
      }
    }
    Eigen::MatrixXd joined = joins.transpose() * dense * joins;
    for (Eigen::Index k = 0; k < 75; ++k) joined(k, k) += joined(k, k) == 0 ? 1 : 0;  // the right nodes' own
    const Eigen::VectorXd expected = joins * joined.ldlt().solve(joins.transpose() * b);
    double most = 0;
    for (int r = 0; r < 5; ++r) {
      for (int c = 0; c < 5; ++c) {
        const std::size_t i = grid.index(r, c);
        const Vec3 found(level.x.x[i], level.x.y[i], level.x.z[i]);
        most = std::max(most, (found - Vec3(expected.segment<3>(row(r, c)))).cwiseAbs().maxCoeff());
      }
    }
    return most;
  }
};

// One solver takes up the numbers of one matrix after another, each solved as a dense one is.
TEST(CoarseSolver, SolvesEachMatrixThatItTakesUp) {
  for (const bool sewn : {false, true}) {
    std::optional<Seam<double>> seam;
    if (sewn) seam.emplace(Grid::with_nodes(5, 5));
    CoarseSolver<double> solver(Grid::with_nodes(5, 5), sewn ? &*seam : nullptr);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      RandomMatrix matrix(seed, sewn);
      solver.factorise(matrix.level.matrix, nullptr);
      solver.solve(matrix.level.b, matrix.level.x);
      EXPECT_LT(matrix.difference(sewn ? &*seam : nullptr), 1e-12) << sewn << seed;
    }
  }
}

// A plate's stencils, stiffness * w w^T of their nodes' weights w, and blocks at the nodes are a part of the
// matrix, whichever stiffness comes second; fixed nodes are not.
TEST(CoarseSolver, SolvesWithAPlateAndBlocks) {
  CoarseSolver<double> solver(Grid::with_nodes(5, 5), nullptr);
  for (const std::uint64_t seed : {1U, 2U}) {
    RandomMatrix matrix(seed, false);
    const Grid& grid = matrix.grid;
    Field<double> inverse_mass(grid);
    inverse_mass.fill(1);
    inverse_mass.at(0, 1) = 0;
    const auto stiffness = static_cast<double>(seed);
    const Plate<double> plate({stiffness, 2 * stiffness, 3 * stiffness}, {1, 1}, inverse_mass);
    matrix.level.use_blocks(true);
    const auto is_fixed = [](int r, int c) { return r == 0 && c == 1; };
    for (int r = 0; r < 5; ++r) {
      for (int c = 0; c < 5; ++c) {
        const kernels::Blocks<double>& blocks = matrix.level.matrix.blocks;
        const std::size_t i = grid.index(r, c);
        blocks.xx[i] = 2 + r;
        blocks.yz[i] = 0.5;
        blocks.yy[i] = blocks.zz[i] = 1 + c;
        if (is_fixed(r, c)) continue;
        auto block = matrix.dense.block<3, 3>(RandomMatrix::row(r, c), RandomMatrix::row(r, c));
        block += Eigen::Matrix3d{{2.0 + r, 0, 0}, {0, 1.0 + c, 0.5}, {0, 0.5, 1.0 + c}};
      }
    }
    plate.for_each_stencil([&](double resists, const auto& nodes) {
      Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(75, 3);
      for (const auto& node : nodes) {
        if (node.weight == 0 || is_fixed(node.row, node.col)) continue;
        weights.block<3, 3>(RandomMatrix::row(node.row, node.col), 0).diagonal().array() += node.weight;
      }
      matrix.dense += resists * weights * weights.transpose();
    });
    solver.factorise(matrix.level.matrix, &plate);
    solver.solve(matrix.level.b, matrix.level.x);
    EXPECT_LT(matrix.difference(nullptr), 1e-11) << seed;
  }
}

}  // namespace
}  // namespace weft
