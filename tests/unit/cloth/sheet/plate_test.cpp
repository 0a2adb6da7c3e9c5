// The plate: its energy, force and bounds, and XPBD's sweep over it.
#include "cloth/sheet/plate.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "cloth/integrators/symplectic_euler.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::kFrame;
using test::Rig;
using test::set;

constexpr Rigidity kUneven{2e-3, 5e-4, 1e-3};
const std::vector<std::pair<int, int>> kGrids{{2, 2}, {2, 5},  {3, 3},   {5, 7},
                                              {9, 9}, {7, 34}, {12, 17}, {17, 66}};

/// Every node free, but for a clamped corner patch of 2 x 3 nodes and one held node, if `held`.
Field<double> inverse_masses(const Grid& grid, bool held) {
  Field<double> inverse_mass(grid);
  each_node(grid, [&](int r, int c) {
    const bool pinned = held && ((r < 2 && c < 3) || (r == grid.rows - 1 && c == grid.cols / 2));
    inverse_mass.at(r, c) = pinned ? 0 : 1;
  });
  return inverse_mass;
}

Plate<double> plate_on(const Grid& grid, bool held = false) {
  return {kUneven, {2, 1}, inverse_masses(grid, held)};
}

VectorField<double> force_of(const Plate<double>& plate, const VectorField<double>& position) {
  VectorField<double> force(position.grid());
  plate.add_forces(position, force);
  return force;
}

/// K, put together stencil by stencil: a node's number is its row times the columns plus its column.
Eigen::MatrixXd matrix_of(const Plate<double>& plate) {
  const Grid& grid = plate.grid();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(grid.nodes(), grid.nodes());
  plate.for_each_stencil([&](double stiffness, const auto& nodes) {
    for (const auto& i : nodes) {
      for (const auto& j : nodes)
        k(i.row * grid.cols + i.col, j.row * grid.cols + j.col) += stiffness * i.weight * j.weight;
    }
  });
  return k;
}

TEST(Plate, ForceIsMinusTheStencilsMatrixTimesThePositionsSlow) {
  // Sums of 13 terms; stiffnesses up to 2e-3 N m * hy / hx^3.
  for (const auto& [rows, cols] : kGrids) {
    for (const bool held : {false, true}) {
      const Grid grid = Grid::with_nodes(rows, cols);
      const Plate<double> plate = plate_on(grid, held);
      const Eigen::MatrixXd k = matrix_of(plate);
      VectorField<double> position(grid);
      test::randomise(position, -1, 1, 1);
      const VectorField<double> force = force_of(plate, position);
      Eigen::MatrixXd r(grid.nodes(), 3);
      each_node(grid, [&](int row, int col) { r.row(row * grid.cols + col) = get(position, row, col); });
      const Eigen::MatrixXd expected = -k * r;
      const Field<double> free = inverse_masses(grid, held);
      each_node(grid, [&](int row, int col) {
        const Vec3 sum = free.at(row, col) * expected.row(row * grid.cols + col).transpose();
        EXPECT_LT((get(force, row, col) - sum).norm(), 1e-13 * (1 + k.maxCoeff()))
            << grid.rows << " x " << grid.cols;
      });
    }
  }
}

TEST(Plate, RowsInBandsGiveTheSameBits) {
  const Grid grid = Grid::with_nodes(17, 34);
  const Plate<double> plate = plate_on(grid, true);
  const Field<double> free = inverse_masses(grid, true);
  VectorField<double> x(grid), whole(grid), parts(grid);
  test::randomise(x, -1, 1, 2);
  std::vector<double> work(kernels::plate_work_size(grid));
  const auto add = [&](VectorField<double>& y, kernels::RowRange rows) {
    return kernels::add_plate<double>(plate.stencils(), grid, kernels::components(std::as_const(x)),
                                      free.row(0), kernels::components(y), rows, work.data());
  };
  const double product = add(whole, {0, 17});
  const double sum = add(parts, {0, 1}) + add(parts, {1, 4}) + add(parts, {4, 16}) + add(parts, {16, 17});
  EXPECT_TRUE(test::same_bits(whole, parts));
  EXPECT_NEAR(sum, product, 1e-12 * product);
}

TEST(Plate, ForceIsMinusTheEnergysGradient) {
  // Quadratic: the central difference is exact but for rounding.
  const Grid grid = Grid::with_nodes(6, 7);
  const Plate<double> plate = plate_on(grid);
  VectorField<double> position(grid);
  test::randomise(position, -1, 1, 3);
  const VectorField<double> force = force_of(plate, position);
  each_node(grid, [&](int r, int c) {
    const Vec3 home = get(position, r, c);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-3;
      set(position, r, c, home + kStep * Vec3::Unit(axis));
      const double more = plate.energy(position);
      set(position, r, c, home - kStep * Vec3::Unit(axis));
      const double gradient = (more - plate.energy(position)) / (2 * kStep);
      set(position, r, c, home);
      EXPECT_NEAR(get(force, r, c)[axis], -gradient, 1e-9);
    }
  });
}

TEST(Plate, KeepsMomentumAndAngularMomentum) {
  const Grid grid = Grid::with_nodes(9, 12);
  VectorField<double> position(grid);
  test::randomise(position, -1, 1, 4);
  const VectorField<double> force = force_of(plate_on(grid), position);
  test::expect_no_net_force(position, force);
}

TEST(Plate, AFlatSheetFeelsNothingWhereverItIs) {
  // Turned, moved and even stretched: the second differences of a linear map are zero. What rounding of
  // positions of up to 12 m leaves is 2e-15 m times 0.5 N/m.
  const Grid grid = Grid::with_nodes(9, 9);
  const Quaternion turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  VectorField<double> position(grid);
  each_node(grid,
            [&](int r, int c) { set(position, r, c, Vec3(3, -7, 9) + turn * Vec3(0.3 * c, 0.1 * r, 0)); });
  const VectorField<double> force = force_of(plate_on(grid), position);
  each_node(grid, [&](int r, int c) { EXPECT_LT(get(force, r, c).norm(), 1e-13); });
}

/// Energy of a 1 m square rolled onto a cylinder of radius 0.5 m whose axis is square to the direction at
/// `angle` from u, with n x n cells.
double rolled(const Rigidity& rigidity, double angle, int n) {
  constexpr double kRadius = 0.5;
  const Grid grid = Grid::with_nodes(n + 1, n + 1);
  Field<double> free(grid);
  free.fill(1);
  VectorField<double> position(grid);
  each_node(grid, [&](int r, int c) {
    const double u = double(c) / n, v = double(r) / n;
    const double along = std::cos(angle) * u + std::sin(angle) * v,
                 across = std::cos(angle) * v - std::sin(angle) * u;
    set(position, r, c, {kRadius * std::sin(along / kRadius), across, kRadius * std::cos(along / kRadius)});
  });
  return Plate<double>(rigidity, {1, 1}, free).energy(position);
}

TEST(Plate, ARolledSheetHoldsItsRigidityInThatDirection) {
  // B/(2 R^2) a square metre: of u, of v, and along the bias (u + v + 2 twist) / 4. Of first order, as
  // free borders hold no moment at their last node, half a cell's width on either side.
  const double quarter = std::numbers::pi / 4;
  const double curvature = 1 / (2 * 0.5 * 0.5);
  for (const int n : {16, 64, 256}) {
    const double tolerance = 1.1 / n;
    EXPECT_NEAR(rolled(kUneven, 0, n), kUneven.u * curvature, tolerance * kUneven.u * curvature);
    EXPECT_NEAR(rolled(kUneven, 2 * quarter, n), kUneven.v * curvature, tolerance * kUneven.v * curvature);
    const double bias = (kUneven.u + kUneven.v + 2 * kUneven.twist) / 4 * curvature;
    EXPECT_NEAR(rolled(kUneven, quarter, n), bias, tolerance * bias);
    EXPECT_NEAR(rolled({1e-3, 1e-3, 1e-3}, 0.3, n), 1e-3 * curvature, tolerance * 1e-3 * curvature);
  }
}

TEST(Plate, BoundsHold) {
  // The smoother's D: K <= 2 D. The stiffest mode: at most the bound, which is exact for the checkerboard of
  // an infinite plate; held to a finite one by 6 %.
  const Grid grid = Grid::with_nodes(17, 17);
  for (const bool held : {false, true}) {
    const Plate<double> plate = plate_on(grid, held);
    const Eigen::MatrixXd k = matrix_of(plate);
    Eigen::VectorXd d(grid.nodes());
    each_node(grid, [&](int r, int c) { d[r * 17 + c] = plate.smoother().at(r, c); });
    const Eigen::VectorXd scale = d.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * k * scale.asDiagonal();
    EXPECT_LE(scaled.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 2 + 1e-12);

    Particles<double> sheet(grid);
    test::share_mass(sheet, 0.2, Discretization::continuum);
    Eigen::VectorXd mass(grid.nodes());
    each_node(grid, [&](int r, int c) { mass[r * 17 + c] = sheet.mass.at(r, c); });
    const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd weighted = root.asDiagonal() * k * root.asDiagonal();
    const double stiffest = weighted.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    const double bound = plate.max_squared_frequency(sheet.mass);
    EXPECT_LE(stiffest, bound);
    if (!held) {
      EXPECT_GE(stiffest, 0.94 * bound);
    }
  }
}

TEST(Plate, CoarserIsTheSameSheetOnEverySecondNode) {
  const Grid fine = Grid::with_nodes(17, 33);
  const Plate<double> coarse = plate_on(fine, true).coarser();
  Field<double> inverse_mass(Grid::with_nodes(9, 17));
  const Field<double> of_fine = inverse_masses(fine, true);
  each_node(inverse_mass.grid(), [&](int r, int c) { inverse_mass.at(r, c) = of_fine.at(2 * r, 2 * c); });
  const Plate<double> made(kUneven, {2, 1}, inverse_mass);
  EXPECT_TRUE((matrix_of(coarse) - matrix_of(made)).isZero(0));
}

// --- XPBD ---

TEST(PlateSweep, IsThatOfAPlainLoopOverColouredStencils) {
  // Each stencil is projected once: along u by the middle's column modulo 4, along v by its row modulo 3,
  // then cells by the parity of row and column, even columns of a row before odd ones.
  constexpr double h = 0.01;
  for (const auto& [rows, cols] : kGrids) {
    Particles<double> sheet = test::flat_sheet<double>(rows, cols, {2, 2});
    sheet.inverse_mass.at(0, 0) = 0;
    Material material = test::without_springs();
    material.rigidity = {2, 5, 1};
    Rig<double> rig(std::move(sheet), {2, 2}, material, Discretization::continuum, {PlateBendingEffect{}},
                    XpbdDescription{1});
    test::randomise(rig.particles.position, -1, 1, 5);
    Particles<double> plain = rig.particles;
    const auto colour_of = [](const auto& nodes) {
      const auto& first = nodes[0];
      const auto& second = nodes[1];
      if (nodes[3].weight != 0) return 7 + first.row % 2 * 2 + first.col % 2;
      return first.row == second.row ? (second.col - 1) % 4 : 4 + (second.row - 1) % 3;
    };
    for (int colour = 0; colour < 11; ++colour) {
      rig.sheet.plate()->for_each_stencil([&](double stiffness, const auto& nodes) {
        if (colour_of(nodes) != colour) return;
        Vec3 constraint = Vec3::Zero();
        double weight = 1 / (stiffness * h * h);
        for (const auto& node : nodes) {
          constraint += node.weight * get(plain.position, node.row, node.col);
          weight += node.weight * node.weight * plain.inverse_mass.at(node.row, node.col);
        }
        for (const auto& node : nodes) {
          const double w = plain.inverse_mass.at(node.row, node.col);
          set(plain.position, node.row, node.col,
              get(plain.position, node.row, node.col) - w * node.weight / weight * constraint);
        }
      });
    }
    rig.advance(0, h);
    EXPECT_LT(test::largest_difference(rig.particles.position, plain.position), 1e-13)
        << rows << " x " << cols;
  }
}

// --- Stability ---

TEST(Plate, SymplecticEulersOwnSubstepsAreStable) {
  Material material = test::without_springs();
  material.rigidity = {1, 1, 1};
  Rig<double> rig =
      test::sheet_rig<double>(17, 17, SymplecticEulerDescription{}, {PlateBendingEffect{}}, material);
  rig.particles.position.z.at(8, 8) = 1e-3;
  const double before = rig.sheet.plate()->energy(rig.particles.position);
  const AdvanceReport report = rig.advance(0, kFrame);
  EXPECT_EQ(report.substeps,
            stable_substeps(rig.sheet.plate()->max_squared_frequency(rig.particles.mass), 0, kFrame, 0.9));
  for (int n = 1; n < 60; ++n) rig.advance(n * kFrame, kFrame);
  // The modified energy is kept: up to 19 times the true one at 0.9 of the limit (criteria.h).
  EXPECT_LT(rig.sheet.plate()->energy(rig.particles.position), 19 * before);
}

TEST(Plate, AnyRigidityIsStableWithOneStepAFrame) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription{BackwardEulerDescription{}}, IntegratorDescription{Bdf2Description{}},
        IntegratorDescription{XpbdDescription{1}}}) {
    for (const double rigidity : {1e-8, 1e-4, 1.0, 1e4}) {
      Material material = test::without_springs();
      material.rigidity = {rigidity, rigidity, rigidity};
      Rig<float> rig = test::sheet_rig<float>(17, 17, stepping, {PlateBendingEffect{}}, material);
      test::randomise(rig.particles.velocity, -1, 1, 6);
      const double speed = 2;  // of any node at the start, m/s
      for (int n = 0; n < 120; ++n) rig.advance(n * kFrame, kFrame);
      each_node(rig.particles.grid(), [&](int r, int c) {
        ASSERT_LT(rig.particles.velocity_at(r, c).norm(), 2 * speed) << rigidity;
      });
    }
  }
}

}  // namespace
}  // namespace weft
