// Eq. 1: one spring, the three kinds of springs of a sheet, and which of them exist. Frequencies:
// spring_modes_test.cpp.
#include "cloth/sheet/springs.h"

#include <gtest/gtest.h>

#include <set>

#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::flat_sheet;
using test::get;
using test::set;
using test::stiffnesses;

const SpringFamily* find_family(const std::vector<SpringFamily>& families, int rows, int cols) {
  for (const SpringFamily& family : families) {
    if (family.rows == rows && family.cols == cols) return &family;
  }
  return nullptr;
}

// --- One spring ---

TEST(Spring, ForceAndEnergyOfAStretchedSpring) {
  // d = (3, 4, 0) is 5 m long, 1 m over its rest length: F = -10 N/m * 1 m * (0.6, 0.8, 0); E = 1/2 * 10 *
  // 1^2.
  const Vec3 force = spring_force({3, 4, 0}, 4.0, 10.0);
  EXPECT_NEAR(force.x(), -6.0, 1e-14);
  EXPECT_NEAR(force.y(), -8.0, 1e-14);
  EXPECT_EQ(force.z(), 0.0);
  EXPECT_NEAR(spring_energy({3, 4, 0}, 4.0, 10.0), 5.0, 1e-14);
}

TEST(Spring, ACompressedSpringPushesApart) {
  // 1 m short: the same size, the other way.
  const Vec3 force = spring_force({3, 4, 0}, 6.0, 10.0);
  EXPECT_NEAR(force.x(), 6.0, 1e-14);
  EXPECT_NEAR(force.y(), 8.0, 1e-14);
  EXPECT_NEAR(spring_energy({3, 4, 0}, 6.0, 10.0), 5.0, 1e-14);
}

TEST(Spring, CoincidentEndsHaveNoDirectionToPushIn) {
  EXPECT_EQ(spring_force(Vec3::Zero(), 1.0, 10.0), Vec3(0, 0, 0));
  EXPECT_EQ(spring_stiffness(Vec3::Zero(), 1.0, 10.0), Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  EXPECT_DOUBLE_EQ(spring_energy(Vec3::Zero(), 2.0, 10.0), 20.0);  // 1/2 * 10 * 2^2
}

TEST(Spring, OfRestLengthZeroIsLinearEvenWhereItsEndsMeet) {
  // E = k d^2 / 2, so that F = -k d and K = k I, whatever the direction.
  const double k = 10;
  const Vec3 d(3, 4, 12);  // 13 m
  EXPECT_LT((spring_force(d, 0.0, k) + k * d).norm(), 1e-13);
  EXPECT_DOUBLE_EQ(spring_energy(d, 0.0, k), 845.0);  // 10 * 13^2 / 2
  EXPECT_LT((spring_stiffness(d, 0.0, k) - k * Eigen::Matrix3d::Identity()).norm(), 1e-13);
  // At d = 0 there is no direction left; what is kept of it is finite, and the force right.
  EXPECT_EQ(spring_force(Vec3::Zero(), 0.0, k), Vec3(0, 0, 0));
  EXPECT_EQ(spring_energy(Vec3::Zero(), 0.0, k), 0.0);
  EXPECT_TRUE(spring_stiffness(Vec3::Zero(), 0.0, k).allFinite());
}

TEST(Spring, ForceIsMinusTheGradientOfTheEnergyAndStiffnessMinusThatOfTheForce) {
  // Central differences with step 1e-5 m err by about step^2 (1e-10) relative, and rounding adds 1e-16/1e-5.
  const double step = 1e-5;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1), length(0.2, 2.0);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 d = Vec3(coordinate(random), coordinate(random), coordinate(random)) + Vec3(0, 0, 1.5);
    const double rest = length(random), k = 100.0 * length(random);
    const Eigen::Matrix3d stiffness = spring_stiffness(d, rest, k);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 e = step * Vec3::Unit(axis);
      const double gradient = (spring_energy(d + e, rest, k) - spring_energy(d - e, rest, k)) / (2 * step);
      EXPECT_NEAR(spring_force(d, rest, k)[axis], -gradient, 1e-6);
      const Vec3 column = (spring_force(d - e, rest, k) - spring_force(d + e, rest, k)) / (2 * step);
      EXPECT_LT((stiffness.col(axis) - column).norm(), 1e-5);
    }
  }
}

// --- Families ---

TEST(Springs, ThreeKindsMakeSixFamiliesWithThePapersConstants) {
  // 2 m x 1 m, 4 x 4 cells of 0.5 m x 0.25 m; paper: the material's constants as they are, borders like the
  // rest.
  const Springs<double> springs(stiffnesses(5000, 500, 5), Discretization::paper, {2, 1},
                                Grid::with_nodes(5, 5));
  ASSERT_EQ(springs.families().size(), 6u);
  const double diagonal = std::sqrt(0.5 * 0.5 + 0.25 * 0.25);
  struct Expected {
    int rows, cols;
    double rest_length, stiffness;
  };
  for (const Expected& e :
       {Expected{0, 1, 0.5, 5000}, Expected{1, 0, 0.25, 5000}, Expected{1, 1, diagonal, 500},
        Expected{1, -1, diagonal, 500}, Expected{0, 2, 1.0, 5}, Expected{2, 0, 0.5, 5}}) {
    const SpringFamily* family = find_family(springs.families(), e.rows, e.cols);
    ASSERT_NE(family, nullptr) << e.rows << ", " << e.cols;
    EXPECT_DOUBLE_EQ(family->rest_length, e.rest_length);
    EXPECT_DOUBLE_EQ(family->stiffness, e.stiffness);
    EXPECT_EQ(family->border_share, 1.0);
  }
}

TEST(Springs, ContinuumConstantsFollowFromTheCellsShape) {
  // Cells 0.5 m x 0.25 m. Along u: Y hy/hx = 5000 / 2; along v: 5000 * 2. Shear: G d^2 / (2 hx hy) = 500 *
  // 0.3125 / 0.25. Bending as structural, the distance doubled: 5 * 0.25 / 1.0 and 5 * 0.5 / 0.5.
  const Springs<double> springs(stiffnesses(5000, 500, 5), Discretization::continuum, {2, 1},
                                Grid::with_nodes(5, 5));
  ASSERT_EQ(springs.families().size(), 6u);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 0, 1)->stiffness, 2500);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 1, 0)->stiffness, 10000);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 1, 1)->stiffness, 625);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 1, -1)->stiffness, 625);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 0, 2)->stiffness, 1.25);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 2, 0)->stiffness, 5);
  for (const SpringFamily& family : springs.families()) {
    const bool crosses = family.rows != 0 && family.cols != 0;  // a diagonal never lies in the border
    if (!crosses) {
      EXPECT_EQ(family.border_share, 0.5);
    }
  }
}

// The same cells, each direction by its own stiffness.
TEST(Springs, WarpAndWeftHaveTheirOwnConstants) {
  Material material = stiffnesses(0, 500, 5);
  material.structural = {5000, 300};
  const Springs<double> springs(material, Discretization::continuum, {2, 1}, Grid::with_nodes(5, 5));
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 0, 1)->stiffness, 2500);
  EXPECT_DOUBLE_EQ(find_family(springs.families(), 1, 0)->stiffness, 600);
  const Springs<double> paper(material, Discretization::paper, {2, 1}, Grid::with_nodes(5, 5));
  EXPECT_EQ(find_family(paper.families(), 0, 1)->stiffness, 5000);
  EXPECT_EQ(find_family(paper.families(), 1, 0)->stiffness, 300);
}

TEST(Springs, AFamilyWithoutStiffnessIsAbsent) {
  const Grid grid = Grid::with_nodes(9, 9);
  const auto count = [&](double structural, double shear, double bending) {
    return Springs<float>(stiffnesses(structural, shear, bending), Discretization::continuum, {1, 1}, grid)
        .families()
        .size();
  };
  EXPECT_EQ(count(1, 0, 0), 2u);
  EXPECT_EQ(count(0, 1, 0), 2u);
  EXPECT_EQ(count(0, 0, 1), 2u);
  EXPECT_EQ(count(1, 0, 1), 4u);
  EXPECT_EQ(count(0, 0, 0), 0u);
}

// --- Which springs a sheet has ---

using NodePair = std::pair<int, int>;  // two nodes, numbered row by row, the lower one first

/// Moves one node at a time and sees whose force changes: exactly those it shares a spring with.
std::set<NodePair> links_by_probing(const Springs<double>& springs, Particles<double> sheet) {
  const Grid grid = sheet.grid();
  VectorField<double> before(grid), after(grid);
  springs.add_forces(sheet.position, before);
  std::set<NodePair> links;
  each_node(grid, [&](int r, int c) {
    const Vec3 home = sheet.position_at(r, c);
    set(sheet.position, r, c, home + Vec3(0.01, 0.02, 0.07));
    after.fill(0);
    springs.add_forces(sheet.position, after);
    set(sheet.position, r, c, home);
    const int moved = r * grid.cols + c;
    each_node(grid, [&](int r2, int c2) {
      const int other = r2 * grid.cols + c2;
      if (other != moved && get(before, r2, c2) != get(after, r2, c2)) {
        links.emplace(std::min(moved, other), std::max(moved, other));
      }
    });
  });
  return links;
}

struct KindCase {
  const char* name;
  Material material;
  std::vector<std::pair<int, int>> offsets;  // row, column to the other end
  std::size_t count;                         // of such springs on 4 x 6 nodes
};

std::ostream& operator<<(std::ostream& out, const KindCase& kind) { return out << kind.name; }

class SpringKinds : public ::testing::TestWithParam<KindCase> {};

TEST_P(SpringKinds, ExactlyTheSpringsOfFigure1Exist) {
  const int rows = 4, cols = 6;
  Particles<double> sheet = flat_sheet<double>(rows, cols, {2.5, 1.5});
  // A bent sheet, so that every spring is under load and none hides behind a zero force.
  each_node(sheet.grid(),
            [&](int r, int c) { sheet.position.z.at(r, c) = 0.1 * (r * r + 1.3 * c * c + r * c); });
  std::set<NodePair> expected;
  each_node(sheet.grid(), [&](int r, int c) {
    for (const auto& [dr, dc] : GetParam().offsets) {
      const int r2 = r + dr, c2 = c + dc;
      if (r2 < rows && c2 >= 0 && c2 < cols) expected.emplace(r * cols + c, r2 * cols + c2);
    }
  });
  ASSERT_EQ(expected.size(), GetParam().count);
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    EXPECT_EQ(links_by_probing(Springs<double>(GetParam().material, d, {2.5, 1.5}, sheet.grid()), sheet),
              expected);
  }
}

// On R x C nodes: structural R (C-1) + (R-1) C, shear 2 (R-1) (C-1), bending R (C-2) + (R-2) C.
INSTANTIATE_TEST_SUITE_P(
    Eq1, SpringKinds,
    ::testing::Values(
        KindCase{"structural", stiffnesses(100, 0, 0), {{0, 1}, {1, 0}}, 4 * 5 + 3 * 6},
        KindCase{"shear", stiffnesses(0, 100, 0), {{1, 1}, {1, -1}}, 2 * 3 * 5},
        KindCase{"bending", stiffnesses(0, 0, 100), {{0, 2}, {2, 0}}, 4 * 4 + 2 * 6},
        KindCase{"all", stiffnesses(100, 70, 30), {{0, 1}, {1, 0}, {1, 1}, {1, -1}, {0, 2}, {2, 0}}, 96}),
    [](const auto& kind) { return std::string(kind.param.name); });

// --- Forces of small sheets, by hand ---

TEST(Springs, StructuralAndShearForcesOfOneCell) {
  // A unit cell whose lower right corner hangs 1 m too low: a = (0,1) b = (1,1) c = (0,0) d = (1,-1), metres.
  //   b-d is 2 m long:        100 N/m * 1 m, straight down on b
  //   c-d is sqrt(2) m long:  100 (sqrt2 - 1) along (1,-1)/sqrt2 on c
  //   a-d (shear, rest sqrt2) is sqrt(5): 50 (sqrt5 - sqrt2) along (1,-2)/sqrt5 on a
  //   a-b, a-c and b-c (shear) are at rest.
  Particles<double> cell = flat_sheet<double>(2, 2, {1, 1});
  set(cell.position, 1, 1, cell.position_at(1, 1) + Vec3(0, -1, 0));
  const Springs<double> springs(stiffnesses(100, 50, 10), Discretization::paper, {1, 1}, cell.grid());
  VectorField<double> force(cell.grid());
  springs.add_forces(cell.position, force);
  const Vec3 on_a = 50 * (std::sqrt(5.0) - std::sqrt(2.0)) / std::sqrt(5.0) * Vec3(1, -2, 0);
  const Vec3 on_b = {0, -100, 0};
  const Vec3 on_c = 100 * (std::sqrt(2.0) - 1) / std::sqrt(2.0) * Vec3(1, -1, 0);
  EXPECT_LT((get(force, 0, 0) - on_a).norm(), 1e-12);
  EXPECT_LT((get(force, 0, 1) - on_b).norm(), 1e-12);
  EXPECT_LT((get(force, 1, 0) - on_c).norm(), 1e-12);
  EXPECT_LT((get(force, 1, 1) + on_a + on_b + on_c).norm(), 1e-12);
  // 1/2 k x^2 of the three.
  const double energy =
      50 + 50 * std::pow(std::sqrt(2.0) - 1, 2) + 25 * std::pow(std::sqrt(5.0) - std::sqrt(2.0), 2);
  EXPECT_NEAR(springs.energy(cell.position), energy, 1e-12);
}

TEST(Springs, BendingForceReachesTheSecondNeighbour) {
  // 3 x 3 nodes 1 m apart, bending only: node (1,2) pulled 0.5 m to the right loads only its spring to (1,0).
  Particles<double> sheet = flat_sheet<double>(3, 3, {2, 2});
  set(sheet.position, 1, 2, sheet.position_at(1, 2) + Vec3(0.5, 0, 0));
  const Springs<double> springs(stiffnesses(0, 0, 10), Discretization::paper, {2, 2}, sheet.grid());
  VectorField<double> force(sheet.grid());
  springs.add_forces(sheet.position, force);
  each_node(sheet.grid(), [&](int r, int c) {
    const double expected = r == 1 && c == 0 ? 5.0 : r == 1 && c == 2 ? -5.0 : 0.0;
    EXPECT_NEAR(get(force, r, c).x(), expected, 1e-13) << r << ", " << c;
  });
}

TEST(Springs, ContinuumBorderSpringsAreHalfAsStiff) {
  // 3 x 3 nodes 1 m apart, the right column moved 0.1 m out: the three rows' springs pull with Y 0.1 inside,
  // half of it in the top and bottom rows, so the total is Y * strain * width = 100 * 0.1 * 2.
  Particles<double> sheet = flat_sheet<double>(3, 3, {2, 2});
  for (int r = 0; r < 3; ++r) sheet.position.x.at(r, 2) += 0.1;
  const Springs<double> springs(stiffnesses(100, 0, 0), Discretization::continuum, {2, 2}, sheet.grid());
  VectorField<double> force(sheet.grid());
  springs.add_forces(sheet.position, force);
  EXPECT_NEAR(force.x.at(0, 2), -5.0, 1e-12);
  EXPECT_NEAR(force.x.at(1, 2), -10.0, 1e-12);
  EXPECT_NEAR(force.x.at(2, 2), -5.0, 1e-12);
}

TEST(Springs, ForcesAreAddedToWhatIsThere) {
  const Particles<double> sheet = flat_sheet<double>(3, 3, {1, 1});
  const Springs<double> springs(stiffnesses(100, 50, 10), Discretization::paper, {2, 2}, sheet.grid());
  VectorField<double> once(sheet.grid()), on_top(sheet.grid());
  on_top.fill(7.0);
  springs.add_forces(sheet.position, once);
  springs.add_forces(sheet.position, on_top);
  each_node(sheet.grid(), [&](int r, int c) {
    EXPECT_LT((get(on_top, r, c) - get(once, r, c) - Vec3(7, 7, 7)).norm(), 1e-12);
  });
}

TEST(Springs, EnergyOfAUniformlyStretchedSheet) {
  // Every spring of rest length l is s l longer: E = sum over kinds of count * 1/2 k (s l)^2. On 5 x 9 nodes
  // 0.25 m apart the counts are 5*8 + 4*9 structural, 2*4*8 shear, 5*7 + 3*9 bending.
  const double s = 0.01, h = 0.25;
  const Particles<double> stretched = flat_sheet<double>(5, 9, Vec2(2, 1) * (1 + s));
  const Springs<double> springs(stiffnesses(100, 50, 10), Discretization::paper, {2, 1}, stretched.grid());
  const double structural = (5 * 8 + 4 * 9) * 0.5 * 100 * std::pow(s * h, 2);
  const double shear = 2 * 4 * 8 * 0.5 * 50 * 2 * std::pow(s * h, 2);
  const double bending = (5 * 7 + 3 * 9) * 0.5 * 10 * std::pow(s * 2 * h, 2);
  EXPECT_NEAR(springs.energy(stretched.position), structural + shear + bending, 1e-13);
  // Continuum: energy per area of a sheet stretched both ways is Y s^2, whatever the grid.
  const Springs<double> continuum(stiffnesses(100, 0, 0), Discretization::continuum, {2, 1},
                                  stretched.grid());
  EXPECT_NEAR(continuum.energy(stretched.position), 100 * s * s * 2.0 * 1.0, 1e-13);
}

// --- Whole sheets against the plain list ---

template <class Real>
class SheetForces : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SheetForces, Scalars);

TYPED_TEST(SheetForces, EqualTheSumOverTheListOfSprings) {
  // Relative to the largest force; a node adds up to 12 springs, so a few dozen roundings.
  const double tolerance = 64 * double(std::numeric_limits<TypeParam>::epsilon());
  for (const auto& [rows, cols] : {std::pair{2, 2}, {3, 3}, {3, 17}, {17, 4}, {20, 33}}) {
    for (Discretization d : {Discretization::paper, Discretization::continuum}) {
      Particles<TypeParam> sheet(Grid::with_nodes(rows, cols));
      test::randomise(sheet.position, -1, 1, 7);
      const Springs<TypeParam> springs(stiffnesses(5000, 500, 50), d, {2, 1}, sheet.grid());
      VectorField<double> expected(sheet.grid());
      VectorField<TypeParam> force(sheet.grid());
      double energy = 0, largest = 0;
      for (const test::ListedSpring& s : test::list_springs(springs.families(), sheet.grid())) {
        const Vec3 d01 = sheet.position_at(s.r0, s.c0) - sheet.position_at(s.r1, s.c1);
        const Vec3 f = spring_force(d01, s.rest_length, s.stiffness);
        set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + f);
        set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - f);
        energy += spring_energy(d01, s.rest_length, s.stiffness);
        largest = std::max(largest, f.norm());
      }
      springs.add_forces(sheet.position, force);
      EXPECT_LT(test::largest_difference(force, expected), tolerance * largest) << rows << " x " << cols;
      EXPECT_NEAR(springs.energy(sheet.position) / energy, 1.0, tolerance);
    }
  }
}

TYPED_TEST(SheetForces, AreFiniteForCoincidentNodes) {
  // All nodes in one point; and one pair of neighbours in one point.
  Particles<TypeParam> point(Grid::with_nodes(9, 9));
  const Springs<TypeParam> springs(stiffnesses(5000, 500, 50), Discretization::continuum, {2, 2},
                                   point.grid());
  VectorField<TypeParam> force(point.grid());
  springs.add_forces(point.position, force);
  each_node(point.grid(), [&](int r, int c) { EXPECT_EQ(get(force, r, c), Vec3(0, 0, 0)); });

  Particles<TypeParam> pair = flat_sheet<TypeParam>(9, 9, {2, 2});
  set(pair.position, 4, 4, pair.position_at(4, 5));
  springs.add_forces(pair.position, force);
  each_node(pair.grid(), [&](int r, int c) { EXPECT_TRUE(get(force, r, c).allFinite()) << r << ", " << c; });
  EXPECT_TRUE(std::isfinite(springs.energy(pair.position)));
}

// A sheet of no height, by the paper's rules: rest length zero from row to row.
TYPED_TEST(SheetForces, OfRestLengthZeroAreLinear) {
  const double k = 5000, apart = 0.25, tolerance = 64 * double(std::numeric_limits<TypeParam>::epsilon());
  Particles<TypeParam> sheet = flat_sheet<TypeParam>(9, 9, {2, 2});
  const Springs<TypeParam> springs(stiffnesses(k, 0, 0), Discretization::paper, {2, 0}, sheet.grid());
  VectorField<TypeParam> force(sheet.grid());
  springs.add_forces(sheet.position, force);
  // k d down at the upper edge, up at the lower one; between them two springs pull alike. Every other spring
  // is at its rest length.
  each_node(sheet.grid(), [&](int r, int c) {
    const double up = r == 0 ? -k * apart : r == 8 ? k * apart : 0;
    EXPECT_LT((get(force, r, c) - Vec3(0, up, 0)).norm(), tolerance * k * apart) << r << ", " << c;
  });
  EXPECT_NEAR(springs.energy(sheet.position), 8 * 9 * k * apart * apart / 2, tolerance * 1e5);

  each_node(sheet.grid(), [&](int r, int c) { set(sheet.position, r, c, sheet.position_at(0, c)); });
  force.fill(TypeParam(0));
  springs.add_forces(sheet.position, force);  // all rows in one: nothing pulls
  each_node(sheet.grid(), [&](int r, int c) { EXPECT_EQ(get(force, r, c).y(), 0) << r << ", " << c; });
  EXPECT_NEAR(springs.energy(sheet.position), 0, tolerance);
}

// The stiffness too: every integrator steps it, apart and with all rows in one, without a division by zero.
TYPED_TEST(SheetForces, OfRestLengthZeroAreStepped) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription(SymplecticEulerDescription{}), IntegratorDescription(XpbdDescription{}),
        IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    for (const double height : {2.0, 0.0}) {
      Particles<TypeParam> sheet = flat_sheet<TypeParam>(9, 9, {2, height});
      test::share_mass(sheet, 0.4, Discretization::paper);
      test::Rig<TypeParam> rig(std::move(sheet), {2, 0}, stiffnesses(5000, 500, 50), Discretization::paper,
                               {}, stepping);
      for (int step = 0; step < 10; ++step) rig.advance(step * test::kFrame, test::kFrame);
      each_node(rig.particles.grid(), [&](int r, int c) {
        EXPECT_TRUE(rig.particles.position_at(r, c).allFinite())
            << stepping.index() << ": " << r << ", " << c;
        EXPECT_TRUE(rig.particles.velocity_at(r, c).allFinite())
            << stepping.index() << ": " << r << ", " << c;
      });
      EXPECT_TRUE(std::isfinite(rig.springs().energy(rig.particles.position))) << stepping.index();
    }
  }
}

TEST(Springs, ForceOnASheetIsMinusTheGradientOfItsEnergy) {
  // Central differences, step 1e-6 m: the error is rounding of the energy, 1e-16 * 1e4 J / 1e-6 m.
  const double step = 1e-6;
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    Particles<double> sheet = flat_sheet<double>(4, 5, {2, 1});
    VectorField<double> noise(sheet.grid()), force(sheet.grid());
    test::randomise(noise, -0.1, 0.1, 3);
    each_node(sheet.grid(),
              [&](int r, int c) { set(sheet.position, r, c, sheet.position_at(r, c) + get(noise, r, c)); });
    const Springs<double> springs(stiffnesses(5000, 500, 50), d, {2, 1}, sheet.grid());
    springs.add_forces(sheet.position, force);
    each_node(sheet.grid(), [&](int r, int c) {
      const Vec3 home = sheet.position_at(r, c);
      for (int axis = 0; axis < 3; ++axis) {
        set(sheet.position, r, c, home + step * Vec3::Unit(axis));
        const double above = springs.energy(sheet.position);
        set(sheet.position, r, c, home - step * Vec3::Unit(axis));
        const double below = springs.energy(sheet.position);
        set(sheet.position, r, c, home);
        EXPECT_NEAR(get(force, r, c)[axis], -(above - below) / (2 * step), 1e-4);
      }
    });
  }
}

TEST(Springs, StructuralStrainByHand) {
  // 3 x 3 nodes 1 m apart, 12 structural springs; the lower right corner 0.5 m out: one spring strained by
  // 0.5, one sqrt(1.25) long, strained by 0.118034; the other ten at rest.
  Particles<double> sheet = flat_sheet<double>(3, 3, {2, 2});
  sheet.position.x.at(2, 2) += 0.5;
  const Springs<double> springs(stiffnesses(100, 50, 10), Discretization::paper, {2, 2}, sheet.grid());
  const StructuralStrain strain = springs.structural_strain(sheet.position);
  EXPECT_NEAR(strain.max, 0.5, 1e-14);
  EXPECT_EQ(strain.max_compression, 0);
  EXPECT_NEAR(strain.mean, (0.5 + std::sqrt(1.25) - 1) / 12, 1e-14);
  // The first spring compressed by 0.75; what is stretched is the other alone, sqrt(1.5625) = 1.25 long.
  sheet.position.x.at(2, 2) -= 1.25;
  const StructuralStrain crumpled = springs.structural_strain(sheet.position);
  EXPECT_NEAR(crumpled.max_compression, 0.75, 1e-14);
  EXPECT_NEAR(crumpled.max, 0.25, 1e-14);
  EXPECT_NEAR(crumpled.mean, (0.75 + 0.25) / 12, 1e-14);
}

}  // namespace
}  // namespace weft
