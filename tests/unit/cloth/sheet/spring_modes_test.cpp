// What an explicit step must respect: the bound on the stiffest mode, against eigenvalues of the assembled
// sheet; and a chain whose frequencies are known (T7).
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "cloth/levels/refine.h"
#include "cloth/sheet/springs.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::stiffnesses;

/// Largest eigenvalue of M^-1/2 K M^-1/2, K summed spring by spring from spring_stiffness.
double largest_eigenvalue(const Particles<double>& sheet, const std::vector<SpringFamily>& families) {
  const Grid grid = sheet.grid();
  const auto first = [&](int r, int c) { return Eigen::Index(3) * (r * grid.cols + c); };
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * grid.nodes(), 3 * grid.nodes());
  for (const test::ListedSpring& s : test::list_springs(families, grid)) {
    const Eigen::Matrix3d k = spring_stiffness(sheet.position_at(s.r0, s.c0) - sheet.position_at(s.r1, s.c1),
                                               s.rest_length, s.stiffness);
    const Eigen::Index i = first(s.r0, s.c0), j = first(s.r1, s.c1);
    a.block<3, 3>(i, i) += k;
    a.block<3, 3>(j, j) += k;
    a.block<3, 3>(i, j) -= k;
    a.block<3, 3>(j, i) -= k;
  }
  Eigen::VectorXd scale(a.rows());
  test::each_node(grid, [&](int r, int c) {
    scale.segment<3>(first(r, c)).setConstant(1 / std::sqrt(sheet.mass.at(r, c)));
  });
  a = scale.asDiagonal() * a * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

struct BoundCase {
  const char* name;
  int rows, cols;
  Vec2 size;
  Material material;
};

std::ostream& operator<<(std::ostream& out, const BoundCase& sheet) { return out << sheet.name; }

class FrequencyBound : public ::testing::TestWithParam<std::tuple<BoundCase, Discretization>> {};

TEST_P(FrequencyBound, HoldsForEveryShape) {
  const auto& [sheet_case, discretization] = GetParam();
  Particles<double> sheet = test::flat_sheet<double>(sheet_case.rows, sheet_case.cols, sheet_case.size);
  test::share_mass(sheet, 0.1 * sheet_case.size.prod(), discretization);
  const Springs<double> springs(sheet_case.material, discretization, sheet_case.size, sheet.grid());
  const double bound = springs.max_squared_frequency(sheet.mass);
  const double rounding = 1 + 1e-10;

  const double flat = largest_eigenvalue(sheet, springs.families());
  EXPECT_LE(flat, bound * rounding) << "flat";
  // A bound that is far too high would be safe and useless. Springs at right angles share the work, so a flat
  // sheet stays below it by a factor, but no more than 3 (x, y and the diagonals) on these grids.
  EXPECT_GE(flat, bound / 3) << "flat";

  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (double spread : {0.01, 0.3, 3.0}) {  // crumpled into a point, tangled, blown up
    test::each_node(sheet.grid(), [&](int r, int c) {
      test::set(sheet.position, r, c, spread * Vec3(normal(random), normal(random), normal(random)));
    });
    EXPECT_LE(largest_eigenvalue(sheet, springs.families()), bound * rounding) << "spread " << spread;
  }
  // All springs along one line, stretched to nothing or beyond their length: the worst case for the bound.
  for (double slope : {1.0, -1.0, 0.37}) {
    test::each_node(sheet.grid(), [&](int r, int c) {
      test::set(sheet.position, r, c, {3.0 * c + 3.0 * slope * r, 0, 0});
    });
    EXPECT_LE(largest_eigenvalue(sheet, springs.families()), bound * rounding) << "line, slope " << slope;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sheets, FrequencyBound,
    ::testing::Combine(::testing::Values(BoundCase{"structural", 6, 6, {2, 2}, stiffnesses(5000, 0, 0)},
                                         BoundCase{"shear", 6, 6, {2, 2}, stiffnesses(0, 500, 0)},
                                         BoundCase{"bending", 6, 6, {2, 2}, stiffnesses(0, 0, 5)},
                                         BoundCase{"cloth", 6, 7, {2, 2}, stiffnesses(5000, 500, 5)},
                                         BoundCase{"shear_heavy", 6, 6, {2, 2}, stiffnesses(500, 5000, 50)},
                                         BoundCase{"bending_heavy", 7, 6, {2, 2}, stiffnesses(100, 50, 5000)},
                                         BoundCase{"long_cells", 6, 6, {2, 0.4}, stiffnesses(5000, 500, 5)},
                                         BoundCase{"strip", 3, 17, {2, 0.5}, stiffnesses(5000, 500, 500)}),
                       ::testing::Values(Discretization::paper, Discretization::continuum)),
    [](const auto& sheet) {
      return std::string(std::get<0>(sheet.param).name) +
             (std::get<1>(sheet.param) == Discretization::paper ? "_paper" : "_continuum");
    });

TEST(FrequencyBound, IsReachedByAnAlignedSheet) {
  // With border nodes of half the mass and border springs of half the stiffness the checkerboard (-1)^(r+c)
  // is a mode of the lattice. Structural springs alone, all on one line: w^2 = 4k/m from each of the two
  // directions. 2 m square, 4 x 4 cells: m = 0.4 kg / 16, k = 5000: 8 * 5000 / 0.025 = 1.6e6 /s2.
  Particles<double> sheet = test::flat_sheet<double>(5, 5, {2, 2});
  test::share_mass(sheet, 0.4, Discretization::continuum);
  const Springs<double> springs(stiffnesses(5000, 0, 0), Discretization::continuum, {2, 2}, sheet.grid());
  test::each_node(sheet.grid(), [&](int r, int c) {
    test::set(sheet.position, r, c, {double(c + r), 0, 0});
  });
  EXPECT_NEAR(largest_eigenvalue(sheet, springs.families()) / 1.6e6, 1.0, 1e-10);
  // The bound may leave room for rounding, no more.
  EXPECT_GE(springs.max_squared_frequency(sheet.mass) / 1.6e6, 1.0);
  EXPECT_LE(springs.max_squared_frequency(sheet.mass) / 1.6e6, 1.0 + 1e-5);
}

TEST(FrequencyBound, IsZeroWithoutSprings) {
  Particles<double> sheet = test::flat_sheet<double>(5, 5, {2, 2});
  const Springs<double> none(stiffnesses(0, 0, 0), Discretization::continuum, {2, 2}, sheet.grid());
  EXPECT_EQ(none.max_squared_frequency(sheet.mass), 0.0);
}

TEST(FrequencyBound, FollowsTheLightestNode) {
  // w^2 = K/m: a node of a quarter of the mass may swing at four times the squared frequency.
  Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
  const Springs<double> springs(stiffnesses(5000, 500, 5), Discretization::paper, {2, 2}, sheet.grid());
  sheet.mass.fill(0.01);
  const double even = springs.max_squared_frequency(sheet.mass);
  sheet.mass.at(4, 4) = 0.0025;
  EXPECT_GE(springs.max_squared_frequency(sheet.mass), largest_eigenvalue(sheet, springs.families()));
  EXPECT_LE(springs.max_squared_frequency(sheet.mass), 4 * even * (1 + 1e-12));
}

TEST(Chain, HasTheKnownFrequencies) {
  // T7: 64 masses of 1e-3 kg between two fixed ends, springs of 1000 N/m, moving along the chain: mode j has
  // x_i = sin(i j pi / 65) and w = 2 sqrt(k/m) sin(j pi / 130), so the force on mass i is -m w^2 x_i.
  // Two equal rows of 66 nodes, whose cross springs stay at rest, are two such chains.
  const double m = 1e-3, k = 1000, amplitude = 1e-3;
  struct Mode {
    int j;
    double hertz;
  };
  for (const Mode& mode : {Mode{1, 7.691559}, Mode{2, 15.378626}, Mode{10, 76.176542}}) {
    Particles<double> chain = test::flat_sheet<double>(2, 66, {65, 1});
    const Springs<double> springs(stiffnesses(k, 0, 0), Discretization::paper, {65, 1}, chain.grid());
    const auto shape = [&](int i) { return amplitude * std::sin(i * mode.j * std::numbers::pi / 65); };
    test::each_node(chain.grid(), [&](int r, int c) { chain.position.x.at(r, c) += shape(c); });
    VectorField<double> force(chain.grid());
    springs.add_forces(chain.position, force);
    const double w = 2 * std::numbers::pi * mode.hertz;
    // The frequencies are given to 1e-6 Hz of at least 7.7 Hz: 3e-7 of w^2.
    for (int i = 1; i <= 64; ++i)
      EXPECT_NEAR(force.x.at(0, i), -m * w * w * shape(i), 3e-7 * m * w * w * amplitude);
  }
}

}  // namespace
}  // namespace weft
