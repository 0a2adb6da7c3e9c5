// One sweep over the threads against the dense matrices that it stands for, by Eigen.
#include "cloth/solver/line_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "cloth/kernels/link_kernels.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

/// Two groups of weft threads and two bands of warp threads, neither of them full.
const Grid kGrid = Grid::with_nodes(19, 35);
constexpr double kDamping = 0.45;

struct RumpledSheet {
  RumpledSheet() : numbers(kGrid, 18), vectors(kGrid, 15) {
    Material material;
    material.bending = 0;
    const Springs<double> springs(material, Discretization::continuum, {2, 2}, kGrid);
    matrix.grid = kGrid;
    int first = 0;
    for (auto* family :
         {&matrix.links.along_u, &matrix.links.along_v, &matrix.links.falling, &matrix.links.rising}) {
      *family = {numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3]};
      first += 4;
    }
    matrix.diagonal = numbers[16];
    matrix.free = numbers[17];
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    each_node(kGrid, [&](int r, int c) {
      const std::size_t i = kGrid.index(r, c);
      position.x[i] = 2.0 * c / (kGrid.cols - 1) + 0.01 * uniform(random);
      position.y[i] = 2.0 * r / (kGrid.rows - 1) + 0.01 * uniform(random);
      position.z[i] = 0.01 * uniform(random);
      numbers[16][i] = 1 + 0.5 * uniform(random);
      numbers[17][i] = fixed(r, c) ? 0 : 1;
      if (fixed(r, c)) return;
      for (double* component : {b.x, b.y, b.z}) component[i] = uniform(random);
    });
    springs.linearise(kGrid, position, matrix.links);
  }
  /// In a corner, and where it cuts a thread of each direction in two.
  static bool fixed(int r, int c) { return (r == 0 && c == 0) || (r == 7 && c == 20); }

  /// damping L^-1 v: of the warp's threads, or the weft's.
  Eigen::VectorXd swept(bool warp, const Eigen::VectorXd& v) const {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(v.size(), v.size());
    const auto add = [&](const kernels::SpringLinks<double>& links, int rows, int cols, bool coupled) {
      each_node(kGrid, [&](int r, int c) {
        const std::size_t i = kGrid.index(r, c);
        const Vec3 m(links.x[i], links.y[i], links.z[i]);
        const Eigen::Matrix3d along = m * m.transpose(),
                              all = links.a[i] * Eigen::Matrix3d::Identity() + along;
        if (all.isZero(0)) return;
        const int from = 3 * (r * kGrid.cols + c), to = 3 * ((r + rows) * kGrid.cols + c + cols);
        dense.block<3, 3>(from, from) += all;
        dense.block<3, 3>(to, to) += all;
        if (!coupled) return;
        dense.block<3, 3>(from, to) -= along;
        dense.block<3, 3>(to, from) -= along;
      });
    };
    add(matrix.links.along_u, 0, 1, !warp);
    add(matrix.links.along_v, 1, 0, warp);
    add(matrix.links.falling, 1, 1, false);
    add(matrix.links.rising, 1, -1, false);
    each_node(kGrid, [&](int r, int c) {
      const int k = 3 * (r * kGrid.cols + c);
      dense.block<3, 3>(k, k) += matrix.diagonal[kGrid.index(r, c)] * Eigen::Matrix3d::Identity();
      if (!fixed(r, c)) return;
      dense.middleRows(k, 3).setZero();
      dense.middleCols(k, 3).setZero();
      dense.block<3, 3>(k, k).setIdentity();
    });
    return kDamping * dense.llt().solve(v);
  }
  static Eigen::VectorXd take(const kernels::Components<double>& field) {
    Eigen::VectorXd values(3 * kGrid.nodes());
    each_node(kGrid, [&](int r, int c) {
      const std::size_t i = kGrid.index(r, c);
      values.segment<3>(3 * (r * kGrid.cols + c)) << field.x[i], field.y[i], field.z[i];
    });
    return values;
  }

  NodeArrays<double> numbers, vectors;
  kernels::LinkMatrix<double, kernels::SpringLinks<double>> matrix;
  kernels::Components<double> position = vectors.vector(0), b = vectors.vector(3), x = vectors.vector(6),
                              z = vectors.vector(9);
};

TEST(LineSmoother, SweepsAreThoseOfBothDirectionsAddedUp) {
  RumpledSheet sheet;
  LineSmoother<double> smoother(kGrid);
  smoother.factorise(sheet.matrix);
  smoother.start(sheet.matrix, sheet.b, sheet.x);
  const Eigen::VectorXd b = RumpledSheet::take(sheet.b);
  const Eigen::VectorXd sweep = sheet.swept(true, b) + sheet.swept(false, b);
  const Eigen::VectorXd once = RumpledSheet::take(sheet.x);
  // The block's share that is added for rounding, 128 x 2e-16 x 3 of some 1e4 N/m, beside 1 N/m.
  const double rounding = 1e-8 * sweep.norm();
  EXPECT_LT((once - sweep).norm(), rounding);
  // With b itself for what x leaves, a second sweep is as long as the first.
  const double product = smoother.finish(sheet.matrix, {sheet.b, sheet.x, sheet.b, sheet.z});
  const Eigen::VectorXd twice = RumpledSheet::take(sheet.z);
  EXPECT_LT((twice - 2 * sweep).norm(), 2 * rounding);
  EXPECT_NEAR(product, b.dot(twice), 1e-12 * std::abs(product));
}

}  // namespace
}  // namespace weft
