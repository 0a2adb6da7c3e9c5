// strain_limit: springs that stiffen beyond a length, in the energy, the force, the linearisation and every
// method.
#include <gtest/gtest.h>

#include <random>

#include "cloth/integrators/symplectic_euler.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/spring_family.h"
#include "cloth/solver/node_arrays.h"
#include "cloth/world/cloth.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::flat_sheet;
using test::get;
using test::kFrame;
using test::ListedSpring;
using test::Rig;
using test::set;

constexpr SpringLimit kLimit{1.1, 20};

TEST(LimitedSpring, IsBilinear) {
  // 1.3 m, 1 m at rest, 10 N/m: 3 N, and 19 times 10 N/m over the 0.2 m beyond 1.1 m: 38 N.
  EXPECT_NEAR(spring_force({1.3, 0, 0}, 1, 10, kLimit).x(), -41, 1e-12);
  EXPECT_NEAR(spring_energy({1.3, 0, 0}, 1, 10, kLimit), 0.45 + 3.8, 1e-12);
  EXPECT_NEAR(spring_stiffness({1.3, 0, 0}, 1, 10, kLimit)(0, 0), 200, 1e-12);
  EXPECT_NEAR(spring_stiffness({1.3, 0, 0}, 1, 10, kLimit)(1, 1), 41 / 1.3, 1e-12);  // tension over length
  // Up to the limit, and compressed, as without one.
  for (const double length : {0.0, 0.5, 1.0, 1.05, 1.1}) {
    const Vec3 d(0, length, 0);
    EXPECT_EQ(spring_force(d, 1, 10, kLimit), spring_force(d, 1, 10));
    EXPECT_EQ(spring_energy(d, 1, 10, kLimit), spring_energy(d, 1, 10));
    EXPECT_EQ(spring_stiffness(d, 1, 10, kLimit), spring_stiffness(d, 1, 10));
  }
}

TEST(LimitedSpring, ForceIsMinusTheGradientOfTheEnergyAndStiffnessMinusThatOfTheForce) {
  // Central differences of step 1e-5 m: errors of 1e-10 relative, rounding of 1e-16 / 1e-5.
  const double step = 1e-5;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1), length(0.2, 2.0);
  int beyond = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 d = Vec3(coordinate(random), coordinate(random), coordinate(random)) + Vec3(0, 0, 1.5);
    const double rest = length(random), k = 100 * length(random);
    const SpringLimit limit{1.2 * rest, 20};
    if (std::abs(d.norm() - limit.length) < 2 * step) continue;  // the stiffness jumps there
    beyond += d.norm() > limit.length ? 1 : 0;
    const Eigen::Matrix3d stiffness = spring_stiffness(d, rest, k, limit);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 e = step * Vec3::Unit(axis);
      const double gradient =
          (spring_energy(d + e, rest, k, limit) - spring_energy(d - e, rest, k, limit)) / (2 * step);
      EXPECT_NEAR(spring_force(d, rest, k, limit)[axis], -gradient, 2e-5);
      const Vec3 column =
          (spring_force(d - e, rest, k, limit) - spring_force(d + e, rest, k, limit)) / (2 * step);
      EXPECT_LT((stiffness.col(axis) - column).norm(), 2e-4);
    }
  }
  EXPECT_GT(beyond, 15);
  EXPECT_LT(beyond, 45);
}

Material limited_material() {
  Material material;
  material.limit = {0.05, 0.1, 0.2, 20};
  return material;
}

Springs<double> limited_springs(const Grid& grid) {
  return Springs<double>(limited_material(), Discretization::continuum, {2, 1}, grid, 0, true);
}

TEST(LimitedSprings, WarpWeftAndShearHaveTheirOwn) {
  // 2 m x 1 m in 4 x 4 cells of 0.5 m x 0.25 m. A parallelogram of these sides that leans by 0.2 rad has the
  // diagonal sqrt(0.5^2 + 0.25^2 + 2 * 0.5 * 0.25 * sin 0.2).
  const double diagonal = std::sqrt(0.25 + 0.0625 + 0.25 * std::sin(0.2));
  const Springs<double> springs = limited_springs(Grid::with_nodes(5, 5));
  ASSERT_EQ(springs.families().size(), 6u);
  for (const SpringFamily& family : springs.families()) {
    const int reach = std::max(family.rows, std::abs(family.cols));
    const double expected = reach == 2         ? std::numeric_limits<double>::infinity()
                            : family.rows == 0 ? 0.5 * 1.05
                            : family.cols == 0 ? 0.25 * 1.1
                                               : diagonal;
    EXPECT_DOUBLE_EQ(family.limit.length, expected);
    EXPECT_EQ(family.limit.stiffening, reach == 2 ? 1 : 20);
  }
}

/// A sheet some of whose springs are beyond their limits, and some crushed.
VectorField<double> uneven(const Grid& grid) {
  VectorField<double> position = flat_sheet<double>(grid.rows, grid.cols, {2, 1}).position, off(grid);
  test::randomise(off, -0.02, 0.02, 7);
  each_node(grid, [&](int r, int c) {
    const Vec3 flat = get(position, r, c), by = get(off, r, c);
    set(position, r, c, 1.08 * flat + by);
  });
  return position;
}

TEST(LimitedSprings, AddEachSpringsForceAndEnergy) {
  for (const auto& [rows, cols] : std::vector<std::pair<int, int>>{{2, 2}, {3, 2}, {5, 7}, {9, 34}}) {
    const Grid grid = Grid::with_nodes(rows, cols);
    const Springs<double> springs = limited_springs(grid);
    const VectorField<double> position = uneven(grid);
    VectorField<double> force(grid), expected(grid);
    double energy = 0;
    int beyond = 0, count = 0;
    for (const SpringFamily& family : springs.families()) {
      for (const ListedSpring& s : test::list_springs({family}, grid)) {
        const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1);
        const Vec3 one = spring_force(d, s.rest_length, s.stiffness, family.limit);
        set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + one);
        set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - one);
        energy += spring_energy(d, s.rest_length, s.stiffness, family.limit);
        beyond += d.norm() > family.limit.length ? 1 : 0;
        ++count;
      }
    }
    springs.add_forces(position, force);
    EXPECT_LT(test::largest_difference(force, expected), 1e-8);  // of up to 1e5 N
    EXPECT_NEAR(springs.energy(position), energy, 1e-12 * energy);
    EXPECT_GT(beyond, 0);
    EXPECT_LT(beyond, count);
  }
}

TEST(LimitedSprings, WithinTheirLimitsAreAsWithout) {
  // Lengths within 2 %, diagonals within 2 %, of limits of 5, 10 and (0.2 rad) 4 %: to the bit.
  const Grid grid = Grid::with_nodes(9, 17);
  VectorField<double> position = flat_sheet<double>(9, 17, {2, 1}).position, off(grid);
  test::randomise(off, -5e-4, 5e-4, 9);
  each_node(grid, [&](int r, int c) { set(position, r, c, get(position, r, c) + get(off, r, c)); });
  VectorField<double> limited(grid), plain(grid);
  limited_springs(grid).add_forces(position, limited);
  Springs<double>(limited_material(), Discretization::continuum, {2, 1}, grid).add_forces(position, plain);
  EXPECT_TRUE(test::same_bits(limited, plain));
}

/// Arrays with margins, as the implicit methods have them.
struct Margined {
  explicit Margined(const VectorField<double>& field) : arrays(field.grid(), 3) {
    each_node(field.grid(), [&](int r, int c) {
      const std::size_t i = field.grid().index(r, c);
      vector().x[i] = field.x.at(r, c);
      vector().y[i] = field.y.at(r, c);
      vector().z[i] = field.z.at(r, c);
    });
  }
  kernels::Components<double> vector() { return arrays.vector(); }
  NodeArrays<double> arrays;
};

/// Stiffness as the implicit methods have it: the sideways part is tension over length, never negative.
Eigen::Matrix3d limited_linear_stiffness(const Vec3& d, double rest_length, double k,
                                         const SpringLimit& limit) {
  const Vec3 n = d.normalized();
  const Eigen::Matrix3d along = n * n.transpose();
  const double tension = -n.dot(spring_force(d, rest_length, k, limit));
  return n.dot(spring_stiffness(d, rest_length, k, limit) * n) * along +
         std::max(0.0, tension) / d.norm() * (Eigen::Matrix3d::Identity() - along);
}

TEST(LimitedSprings, AreLinearisedAsTheyAreBeyondTheirLimits) {
  const Grid grid = Grid::with_nodes(9, 17);
  const Springs<double> springs = limited_springs(grid);
  const VectorField<double> position = uneven(grid);
  Margined at(position);
  NodeArrays<double> numbers(grid, 24);
  const auto links = [&](int i) -> kernels::SpringLinks<double> {
    return {numbers[4 * i], numbers[4 * i + 1], numbers[4 * i + 2], numbers[4 * i + 3]};
  };
  springs.linearise(grid, at.vector(), {links(0), links(1), links(2), links(3), links(4), links(5), true});
  for (std::size_t f = 0; f < 6; ++f) {  // in the order of LinkFamilies
    const SpringFamily& family = springs.families()[f];
    for (const ListedSpring& s : test::list_springs({family}, grid)) {
      const std::size_t i = grid.index(s.r0, s.c0);
      const auto link = links(static_cast<int>(f));
      const Vec3 m(link.x[i], link.y[i], link.z[i]);
      const Eigen::Matrix3d found = link.a[i] * Eigen::Matrix3d::Identity() + m * m.transpose();
      const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1);
      const Eigen::Matrix3d expected = limited_linear_stiffness(d, s.rest_length, s.stiffness, family.limit);
      EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm());
      EXPECT_GE(link.a[i], 0);
    }
  }
}

TEST(LimitedSprings, ModelErrorIsTheEnergyLessItsLinearisation) {
  const Grid grid = Grid::with_nodes(11, 19);
  const Springs<double> springs = limited_springs(grid);
  const VectorField<double> position = uneven(grid);
  for (const double size : {1e-3, 1e-2, 1.0}) {  // of the change; springs pass their limits both ways
    VectorField<double> change(grid);
    test::randomise(change, -size, size, 8);
    double sum = 0, magnitude = 0, energy = 0, struck = 0;
    for (const SpringFamily& family : springs.families()) {
      for (const ListedSpring& s : test::list_springs({family}, grid)) {
        const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1);
        const Vec3 u = get(change, s.r0, s.c0) - get(change, s.r1, s.c1);
        const double after = spring_energy(d + u, s.rest_length, s.stiffness, family.limit);
        const double model =
            spring_energy(d, s.rest_length, s.stiffness, family.limit) -
            spring_force(d, s.rest_length, s.stiffness, family.limit).dot(u) +
            u.dot(limited_linear_stiffness(d, s.rest_length, s.stiffness, family.limit) * u) / 2;
        if (d.norm() <= family.limit.length) {
          struck = std::max(struck, ((d + u).norm() - family.limit.length) / s.rest_length);
        }
        sum += after - model;
        magnitude += std::abs(after - model);
        energy += after + model;
      }
    }
    Margined at(position), by(change);
    const kernels::SpringModelError error = springs.model_error(grid, at.vector(), by.vector());
    EXPECT_GT(magnitude, 1e-5 * energy);  // there is something to compare
    EXPECT_NEAR(error.sum, sum, 1e-13 * energy) << size;
    EXPECT_NEAR(error.magnitude, magnitude, 1e-13 * energy) << size;
    EXPECT_GT(struck, 0);
    EXPECT_NEAR(error.struck, struck, 1e-12 * (1 + struck)) << size;
  }
}

// --- One spring in each method ---

/// Two nodes 1 m apart along x, twice; the left ones held, the right ones of 1 kg on a spring of k N/m.
Rig<double> limited_oscillator(double k, const IntegratorDescription& stepping) {
  Particles<double> sheet = flat_sheet<double>(2, 2, {1, 1});
  for (int r : {0, 1}) sheet.inverse_mass.at(r, 0) = 0;
  Material material = test::without_springs();
  material.structural = k;
  material.limit = {0.05, 0.05, 0.3, 20};
  return {std::move(sheet), {1, 1}, material, Discretization::paper, {StrainLimitEffect{}}, stepping};
}

/// -F / (1 kg) of the right nodes x m beside their home.
double pull(double x, double k) { return k * (x + 19 * std::max(0.0, x - 0.05)); }

/// The x with x + h^2 pull(x) = free: backward Euler's, on the branch that its own solution lies in.
double backward_euler_place(double free, double h, double k) {
  const double soft = free / (1 + h * h * k);
  return soft <= 0.05 ? soft : (free + h * h * k * 19 * 0.05) / (1 + h * h * k * 20);
}

template <class Next>
void expect_limited_steps(Rig<double> rig, double h, Next next) {
  const double home = rig.particles.position.x.at(0, 1);
  for (int r : {0, 1}) rig.particles.position.x.at(r, 1) += 0.2;
  double x = 0.2, v = 0;
  for (int n = 1; n <= 100; ++n) {
    rig.advance((n - 1) * h, h);
    v = next(x, v);
    x += h * v;
    ASSERT_NEAR(rig.particles.position.x.at(0, 1) - home, x, 1e-11) << n;
  }
}

TEST(LimitedOscillator, IsSymplecticEulers) {
  constexpr double h = 0.01, k = 40;
  expect_limited_steps(limited_oscillator(k, SymplecticEulerDescription{1}), h, [](double x, double v) {
    // What is beyond the limit is damped by a quarter of a substep.
    return v - h * (pull(x, k) + (x > 0.05 ? 19 * k * 0.25 * h * v : 0.0));
  });
}

TEST(LimitedOscillator, IsBackwardEulers) {
  constexpr double h = 0.01, k = 40;
  BackwardEulerDescription exact;
  exact.tolerance = 1e-12;
  exact.newton_iterations = 8;
  const auto next = [](double x, double v) { return (backward_euler_place(x + h * v, h, k) - x) / h; };
  expect_limited_steps(limited_oscillator(k, exact), h, next);
  expect_limited_steps(limited_oscillator(k, XpbdDescription{1}), h, next);  // one spring projected once
}

TEST(LimitedOscillator, ThatStrikesItsLimitIsLinearisedAgain) {
  // From 4 cm at 6 m/s: freely it would be at x = 10 cm after a step, on a spring without a limit at 10 / (1
  // + h^2 k) = 9.96 cm, where one linearisation has it, misjudged by 2.6 % of the motion's energy; held by
  // what is stiffer from 5 cm on it is at (10 + 19 h^2 k 5) / (1 + 20 h^2 k) = 9.61 cm.
  constexpr double h = 0.01, k = 40;
  BackwardEulerDescription one_linearisation;
  one_linearisation.tolerance = 1e-9;
  one_linearisation.newton_iterations = 1;
  Rig<double> rig = limited_oscillator(k, one_linearisation);
  const double home = rig.particles.position.x.at(0, 1);
  for (int r : {0, 1}) {
    rig.particles.position.x.at(r, 1) += 0.04;
    rig.particles.velocity.x.at(r, 1) = 6;
  }
  rig.advance(0, h);
  EXPECT_NEAR(rig.particles.position.x.at(0, 1) - home, backward_euler_place(0.1, h, k), 1e-9);
}

TEST(StrainLimit, SymplecticEulersSubstepsKnowOfTheStifferSprings) {
  // All springs are 20 times as stiff there but those to the second neighbour; damping by a quarter of a
  // substep adds 2 * 0.25 w^2 h^2 to what must stay below 4.
  Rig<double> rig = test::sheet_rig<double>(9, 9, SymplecticEulerDescription{}, {StrainLimitEffect{}});
  const Rig<double> plain = test::sheet_rig<double>(9, 9, SymplecticEulerDescription{});
  const double w2 = rig.springs().max_squared_frequency(rig.particles.mass);
  EXPECT_NEAR(w2, 20 * plain.springs().max_squared_frequency(plain.particles.mass), 0.01 * w2);
  EXPECT_EQ(rig.advance(0, kFrame).substeps, stable_substeps(1.5 * w2, 0, kFrame, 0.9));
  // Let go at 1.1 times its size, half of that beyond its warp's limit, it rings without gaining energy.
  each_node(rig.particles.grid(), [&](int r, int c) {
    set(rig.particles.position, r, c, 1.1 * get(rig.particles.position, r, c));
  });
  const double before = rig.springs().energy(rig.particles.position);
  for (int n = 0; n < 120; ++n) {
    rig.advance(n * kFrame, kFrame);
    ASSERT_LT(kinetic_energy(rig.particles) + rig.springs().energy(rig.particles.position), before) << n;
  }
}

TEST(LimitedSprings, AreDampedBeyondTheirLimitsAlone) {
  // Against a list of springs, each by the formula; sums of up to 24 terms of size 1e4 N.
  constexpr double kDamped = 0.01;
  const Grid grid = Grid::with_nodes(9, 17);
  const Springs<double> springs = limited_springs(grid);
  const VectorField<double> position = uneven(grid);
  VectorField<double> velocity(grid), force(grid), expected(grid);
  test::randomise(velocity, -3, 3, 2);
  for (const SpringFamily& family : springs.families()) {
    for (const ListedSpring& s : test::list_springs({family}, grid)) {
      const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1), n = d.normalized();
      if (d.norm() <= family.limit.length) continue;
      const double rate = n.dot(get(velocity, s.r0, s.c0) - get(velocity, s.r1, s.c1));
      const Vec3 one = -kDamped * 19 * s.stiffness * rate * n;
      set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + one);
      set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - one);
    }
  }
  springs.add_limit_damping(position, velocity, kDamped, force);
  EXPECT_LT(test::largest_difference(force, expected), 1e-9);
  EXPECT_GT(test::largest_difference(force, VectorField<double>(grid)), 1e3);
}

TEST(StrainLimit, IsOfTheClothsThatListIt) {
  ClothDescription cloth;
  EXPECT_TRUE(Cloth<float>(cloth, {StrainLimitEffect{}}, XpbdDescription{}, 1).springs().limited());
  EXPECT_FALSE(Cloth<float>(cloth, {GravityEffect{}}, XpbdDescription{}, 1).springs().limited());
}

}  // namespace
}  // namespace weft
