// Threads solved by themselves against the dense systems that they stand for, by Eigen.
#include "cloth/kernels/line_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "cloth/kernels/line_pivots.h"
#include "random_lattice.h"

namespace weft::kernels {
namespace {

constexpr double kLineDamping = 0.7;
/// What the pivots' own addition for rounding, 128 epsilons, and rounding leave of a solve.
constexpr double kLineRounding = 1e-12;

/// 18 x 20 nodes with random links of some N/m; two groups of weft threads, the second one of two. Node (4,
/// 6) is fixed, the links from (8, 3) to the next row and the next column are torn.
struct Threads {
  Threads() {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    matrix.grid = grid;
    int first = 0;
    std::size_t f = 0;
    for (auto* family :
         {&matrix.links.along_u, &matrix.links.along_v, &matrix.links.falling, &matrix.links.rising}) {
      *family = {numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3]};
      const auto [down, right] = fixture::kLatticeFamilies[f++];
      for (int r = 0; r + down < grid.rows; ++r) {
        for (int c = std::max(0, -right); c < grid.cols - std::max(0, right); ++c) {
          if (r == 8 && c == 3) continue;
          for (int number = 0; number < 4; ++number) {
            numbers[first + number][grid.index(r, c)] = number == 0 ? 1 + uniform(random) : uniform(random);
          }
        }
      }
      first += 4;
    }
    matrix.diagonal = numbers[16];
    matrix.free = numbers[17];
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        const std::size_t i = grid.index(r, c);
        numbers[16][i] = 1.5 + uniform(random);
        numbers[17][i] = fixed(r, c) ? 0 : 1;
        for (const auto& field : {b, x, residual}) {
          for (double* component : {field.x, field.y, field.z}) {
            component[i] = fixed(r, c) ? 0 : uniform(random);
          }
        }
      }
    }
  }
  static bool fixed(int r, int c) { return r == 4 && c == 6; }
  Vec3 along(const SpringLinks<double>& link, std::size_t i) const {
    return {link.x[i], link.y[i], link.z[i]};
  }
  /// D and all links at the node.
  Eigen::Matrix3d block(int r, int c) const {
    Eigen::Matrix3d sum = matrix.diagonal[grid.index(r, c)] * Eigen::Matrix3d::Identity();
    const SpringLinks<double>* families[] = {&matrix.links.along_u, &matrix.links.along_v,
                                             &matrix.links.falling, &matrix.links.rising};
    for (std::size_t f = 0; f < 4; ++f) {
      const auto [down, right] = fixture::kLatticeFamilies[f];
      for (const bool second : {false, true}) {
        const int from_r = second ? r - down : r, from_c = second ? c - right : c;
        if (from_r < 0 || from_c < 0 || from_c >= grid.cols) continue;
        const std::size_t i = grid.index(from_r, from_c);
        const Vec3 m = along(*families[f], i);
        sum += families[f]->a[i] * Eigen::Matrix3d::Identity() + m * m.transpose();
      }
    }
    return sum;
  }
  /// L of one thread: warp down column `line`, or weft along row `line`.
  Eigen::MatrixXd thread(bool warp, int line) const {
    const int count = warp ? grid.rows : grid.cols;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * count, 3 * count);
    for (int p = 0; p < count; ++p) {
      const int r = warp ? p : line, c = warp ? line : p;
      dense.block<3, 3>(3 * p, 3 * p) = block(r, c);
      if (p + 1 == count) continue;
      const Vec3 m = along(warp ? matrix.links.along_v : matrix.links.along_u, grid.index(r, c));
      dense.block<3, 3>(3 * p, 3 * p + 3) = -m * m.transpose();
      dense.block<3, 3>(3 * p + 3, 3 * p) = -m * m.transpose();
    }
    for (int p = 0; p < count; ++p) {
      if (!fixed(warp ? p : line, warp ? line : p)) continue;
      dense.middleRows(3 * p, 3).setZero();
      dense.middleCols(3 * p, 3).setZero();
      dense.block<3, 3>(3 * p, 3 * p).setIdentity();
    }
    return dense;
  }
  Eigen::VectorXd on_thread(const Components<double>& field, bool warp, int line) const {
    const int count = warp ? grid.rows : grid.cols;
    Eigen::VectorXd values(3 * count);
    for (int p = 0; p < count; ++p) {
      values.segment<3>(3 * p) = at<double>(field, grid.index(warp ? p : line, warp ? line : p));
    }
    return values;
  }

  Grid grid = Grid::with_nodes(18, 20);
  NodeArrays<double> numbers{grid, 18}, vectors{grid, 18}, node_blocks{grid, 12};
  LinkMatrix<double, SpringLinks<double>> matrix;
  Components<double> b = vectors.vector(0), x = vectors.vector(3), residual = vectors.vector(6),
                     change = vectors.vector(9), moved = vectors.vector(12);
  LineFactors<double> factors{node_blocks.blocks(0), vectors.vector(15)};
  Blocks<double> blocks = node_blocks.blocks(6);
  std::vector<double, AlignedAllocator<double>> work =
      std::vector<double, AlignedAllocator<double>>(line_work_size(grid));

  void factorise_warp_threads() {
    factorise_warp(matrix, blocks, factors, {0, kRowAlign}, work.data());
    factorise_warp(matrix, blocks, factors, {kRowAlign, 2 * kRowAlign}, work.data());
  }
};

Eigen::Matrix3d matrix_at(const Blocks<double>& blocks, std::size_t i) {
  Eigen::Matrix3d m;
  m << blocks.xx[i], blocks.xy[i], blocks.xz[i], blocks.xy[i], blocks.yy[i], blocks.yz[i], blocks.xz[i],
      blocks.yz[i], blocks.zz[i];
  return m;
}

// E_0 = G_0^-1, E_{p+1} = (G_{p+1} - (m_p . E_p m_p) m_p m_p^T)^-1; E = 0 where the node is fixed.
TEST(LineKernels, FactorsAreTheInversePivots) {
  Threads threads;
  threads.factorise_warp_threads();
  for (int c = 0; c < threads.grid.cols; ++c) {
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    for (int r = 0; r < threads.grid.rows; ++r) {
      const std::size_t i = threads.grid.index(r, c);
      Eigen::Matrix3d pivot = threads.block(r, c);
      EXPECT_LT((matrix_at(threads.blocks, i) - pivot).norm(), kLineRounding * pivot.norm());
      if (r > 0) {
        const Vec3 m = threads.along(threads.matrix.links.along_v, threads.grid.index(r - 1, c));
        pivot -= m.dot(inverse * m) * m * m.transpose();
      }
      inverse = Threads::fixed(r, c) ? Eigen::Matrix3d::Zero() : Eigen::Matrix3d(pivot.inverse());
      EXPECT_LT((matrix_at(threads.factors.inverse, i) - inverse).norm(), kLineRounding);
      const Vec3 along = inverse * threads.along(threads.matrix.links.along_v, i);
      EXPECT_LT((at<double>(threads.factors.along, i) - along).norm(), kLineRounding);
    }
  }
}

TEST(LineKernels, WarpThreadsAreSolvedExactly) {
  Threads threads;
  threads.factorise_warp_threads();
  std::vector<Eigen::VectorXd> before;
  for (int c = 0; c < threads.grid.cols; ++c) before.push_back(threads.on_thread(threads.x, true, c));
  for (const ColumnRange& columns : {ColumnRange{0, kRowAlign}, ColumnRange{kRowAlign, 2 * kRowAlign}}) {
    solve_warp<double>(threads.matrix, threads.factors, kLineDamping,
                       {threads.residual, threads.change, threads.x}, columns, threads.work.data());
  }
  for (int c = 0; c < threads.grid.cols; ++c) {
    const Eigen::VectorXd expected =
        kLineDamping * threads.thread(true, c).llt().solve(threads.on_thread(threads.residual, true, c));
    EXPECT_LT((threads.on_thread(threads.change, true, c) - expected).norm(), kLineRounding);
    EXPECT_LT((threads.on_thread(threads.x, true, c) - before[std::size_t(c)] - expected).norm(),
              kLineRounding);
  }
  EXPECT_TRUE(at<double>(threads.change, threads.grid.index(4, 6)).isZero(0));
}

TEST(LineKernels, WeftThreadsAreSolvedExactly) {
  Threads threads;
  threads.factorise_warp_threads();
  std::vector<double, AlignedAllocator<double>> factors(weft_factors_size(threads.grid));
  double product = 0, expected_product = 0;
  for (int first = 0; first < threads.grid.rows; first += kWeftLines) {
    factorise_weft(threads.matrix, threads.blocks, factors.data(), first, threads.work.data());
    product += solve_weft<double>(threads.grid, factors.data(), kLineDamping,
                                  {threads.residual, threads.x, threads.b, threads.moved}, first,
                                  threads.work.data());
  }
  for (int r = 0; r < threads.grid.rows; ++r) {
    const Eigen::VectorXd expected =
        threads.on_thread(threads.x, false, r) +
        kLineDamping * threads.thread(false, r).llt().solve(threads.on_thread(threads.residual, false, r));
    EXPECT_LT((threads.on_thread(threads.moved, false, r) - expected).norm(), kLineRounding);
    expected_product += expected.dot(threads.on_thread(threads.b, false, r));
  }
  EXPECT_NEAR(product, expected_product, kLineRounding);
}

TEST(LinePivots, AlongIsTheShareOfTheOuterProduct) {
  const Vec3 m(0.5, -2, 3), d(1, 0.25, -0.5);
  const Eigen::Matrix3d expected = 0.75 * m * m.transpose();
  const Block<double> found = along(m.x(), m.y(), m.z(), 0.75);
  EXPECT_EQ(found.xx, expected(0, 0));
  EXPECT_EQ(found.xy, expected(0, 1));
  EXPECT_EQ(found.xz, expected(0, 2));
  EXPECT_EQ(found.yy, expected(1, 1));
  EXPECT_EQ(found.yz, expected(1, 2));
  EXPECT_EQ(found.zz, expected(2, 2));
  const Triple<double> product = times(found, d.x(), d.y(), d.z());
  EXPECT_LT((Vec3(product.x, product.y, product.z) - expected * d).norm(), 1e-14);
}

}  // namespace
}  // namespace weft::kernels
