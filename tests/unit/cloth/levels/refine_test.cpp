// Eq. 8 (split), its inverse (merge), Eq. 9 (mass), and what they do to momentum and energy.
#include "cloth/levels/refine.h"

#include <gtest/gtest.h>

#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/springs.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

template <class Real>
Particles<Real> random_state(const Grid& grid, std::uint64_t seed) {
  Particles<Real> state(grid);
  test::randomise(state.position, -1, 1, seed);
  test::randomise(state.velocity, -5, 5, seed + 1);
  test::randomise(state.acceleration, -20, 20, seed + 2);
  return state;
}

template <class Real>
class Refine : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Refine, Scalars);

// --- Eq. 8 ---

TYPED_TEST(Refine, OneCellByHand) {
  // Fig. 3: corners a b / c d. e = (a+b)/2, f = (b+d)/2, g = (d+c)/2, h = (c+a)/2, i = (a+b+c+d)/4, for the
  // position, the velocity and the acceleration alike. All values are exact in either precision.
  Particles<TypeParam> coarse(Grid::with_nodes(2, 2)), fine(Grid::with_nodes(3, 3));
  const Vec3 a(0, 8, 1), b(4, 8, 3), c(0, 0, 5), d(8, -4, 7);
  int scale = 1;
  for (auto* field : {&coarse.position, &coarse.velocity, &coarse.acceleration}) {
    set(*field, 0, 0, a * scale);
    set(*field, 0, 1, b * scale);
    set(*field, 1, 0, c * scale);
    set(*field, 1, 1, d * scale);
    scale *= 2;
  }
  split(coarse, fine);
  scale = 1;
  for (const auto* field : {&fine.position, &fine.velocity, &fine.acceleration}) {
    EXPECT_EQ(get(*field, 0, 0), Vec3(a * scale));
    EXPECT_EQ(get(*field, 0, 2), Vec3(b * scale));
    EXPECT_EQ(get(*field, 2, 0), Vec3(c * scale));
    EXPECT_EQ(get(*field, 2, 2), Vec3(d * scale));
    EXPECT_EQ(get(*field, 0, 1), Vec3(Vec3(2, 8, 2) * scale));   // e
    EXPECT_EQ(get(*field, 1, 2), Vec3(Vec3(6, 2, 5) * scale));   // f
    EXPECT_EQ(get(*field, 2, 1), Vec3(Vec3(4, -2, 6) * scale));  // g
    EXPECT_EQ(get(*field, 1, 0), Vec3(Vec3(0, 4, 3) * scale));   // h
    EXPECT_EQ(get(*field, 1, 1), Vec3(Vec3(3, 3, 4) * scale));   // i
    scale *= 2;
  }
}

TEST(RefineCounts, ASplitCellGainsFiveNodes) {
  // Fig. 3: four corners become nine nodes.
  const Grid cell = Grid::with_nodes(2, 2), split_cell = Grid::with_nodes(3, 3);
  EXPECT_EQ(split_cell.nodes() - cell.nodes(), 5);
  EXPECT_EQ(split_cell.cells(), 4 * cell.cells());
}

TEST(RefineCounts, LevelsHaveThePapersGrids) {
  // Levels 4, 5, 6 are the paper's 16 x 16, 32 x 32 and 64 x 64 cells; nodes of one level nest in the next.
  for (const auto& [level, cells] : {std::pair{3, 8}, {4, 16}, {5, 32}, {6, 64}, {7, 128}, {8, 256}}) {
    const Grid square = BaseCells{}.at(level), wide = BaseCells{2, 1}.at(level);
    EXPECT_EQ(square.rows, cells + 1);
    EXPECT_EQ(square.cols, cells + 1);
    EXPECT_EQ(wide.rows, cells + 1);
    EXPECT_EQ(wide.cols, 2 * cells + 1);
    EXPECT_EQ(square.stride % kRowAlign, 0);
    EXPECT_GE(square.stride, square.cols);
  }
}

TYPED_TEST(Refine, EveryNodeFollowsEquation8) {
  const Grid small = Grid::with_nodes(6, 9), large = Grid::with_nodes(11, 17);
  const Particles<TypeParam> coarse = random_state<TypeParam>(small, 1);
  Particles<TypeParam> fine(large);
  split(coarse, fine);
  // A mean of four values below 20 rounds a few times.
  const double tolerance = 20 * 2 * double(std::numeric_limits<TypeParam>::epsilon());
  each_node(large, [&](int r, int c) {
    const int r0 = r / 2, c0 = c / 2, r1 = (r + 1) / 2, c1 = (c + 1) / 2;
    const auto mean = [&](const VectorField<TypeParam>& f) {
      return Vec3((get(f, r0, c0) + get(f, r0, c1) + get(f, r1, c0) + get(f, r1, c1)) / 4);
    };
    EXPECT_LT((get(fine.position, r, c) - mean(coarse.position)).norm(), tolerance);
    EXPECT_LT((get(fine.velocity, r, c) - mean(coarse.velocity)).norm(), tolerance);
    EXPECT_LT((get(fine.acceleration, r, c) - mean(coarse.acceleration)).norm(), tolerance);
  });
}

TYPED_TEST(Refine, MergeKeepsTheSharedNodesBitForBit) {
  const Particles<TypeParam> fine = random_state<TypeParam>(Grid::with_nodes(17, 33), 2);
  Particles<TypeParam> coarse(Grid::with_nodes(9, 17));
  merge(fine, coarse);
  each_node(coarse.grid(), [&](int r, int c) {
    EXPECT_EQ(get(coarse.position, r, c), get(fine.position, 2 * r, 2 * c));
    EXPECT_EQ(get(coarse.velocity, r, c), get(fine.velocity, 2 * r, 2 * c));
    EXPECT_EQ(get(coarse.acceleration, r, c), get(fine.acceleration, 2 * r, 2 * c));
  });
}

TYPED_TEST(Refine, SplitThenMergeGivesTheSameBits) {
  // T17, on square and rectangular grids of every level, and for awkward values.
  for (const BaseCells base : {BaseCells{1, 1}, BaseCells{2, 1}, BaseCells{3, 5}}) {
    for (int level = kMinLevel; level < 6; ++level) {
      Particles<TypeParam> coarse = random_state<TypeParam>(base.at(level), 10);
      set(coarse.position, 0, 0, {1e30, -1e-30, 1.0 / 3});
      set(coarse.velocity, 1, 1, {1e-38, 1e5, -0.1});
      Particles<TypeParam> fine(base.at(level + 1)), back(base.at(level));
      split(coarse, fine);
      merge(fine, back);
      EXPECT_TRUE(test::same_state(coarse, back)) << base.cols << ":" << base.rows << " level " << level;
    }
  }
}

// --- Eq. 9 ---

TYPED_TEST(Refine, PaperMassIsTheTotalOverTheCount) {
  for (int level = kMinLevel; level <= kMaxLevel; ++level) {
    Field<TypeParam> mass(BaseCells{}.at(level));
    mass_distribution(0.4, Discretization::paper, mass);
    const double n = mass.grid().nodes();
    each_node(mass.grid(), [&](int r, int c) { ASSERT_EQ(mass.at(r, c), mass.at(0, 0)); });
    // Eq. 9 backwards: n m_new = m_total, up to the rounding of one division.
    EXPECT_NEAR(n * double(mass.at(0, 0)) / 0.4, 1.0, 2 * double(std::numeric_limits<TypeParam>::epsilon()));
  }
}

TYPED_TEST(Refine, ContinuumMassIsByAreaAndItsSumTheSameBitsAtEveryLevel) {
  // 0.3 kg is no binary fraction. On a square of 2^L cells a side the shares are the total over a power of
  // two.
  const double total = 0.3;
  const double rounded = double(static_cast<TypeParam>(total));
  for (int level = kMinLevel; level <= kMaxLevel; ++level) {
    Field<TypeParam> mass(BaseCells{}.at(level));
    mass_distribution(total, Discretization::continuum, mass);
    const int last = mass.grid().rows - 1;
    const double inside = double(mass.at(1, 1));
    EXPECT_EQ(inside, rounded / mass.grid().cells()) << level;
    EXPECT_EQ(double(mass.at(0, 1)), inside / 2);
    EXPECT_EQ(double(mass.at(1, last)), inside / 2);
    EXPECT_EQ(double(mass.at(last, 0)), inside / 4);
    EXPECT_EQ(test::exact_sum(mass), rounded) << level;
  }
}

TYPED_TEST(Refine, ContinuumMassOfARectangleIsTheSameAtEveryLevel) {
  // 3 x 5 base cells: the share is rounded once, the same way at every level.
  const BaseCells base{3, 5};
  Field<TypeParam> first(base.at(kMinLevel));
  mass_distribution(0.3, Discretization::continuum, first);
  const double sum = test::exact_sum(first);
  EXPECT_NEAR(sum / 0.3, 1.0, double(std::numeric_limits<TypeParam>::epsilon()));
  for (int level = kMinLevel + 1; level <= 6; ++level) {
    Field<TypeParam> mass(base.at(level));
    mass_distribution(0.3, Discretization::continuum, mass);
    EXPECT_EQ(test::exact_sum(mass), sum) << level;
  }
}

// --- What a level change does to momentum and energy ---

/// One state before and after a level change, masses shared anew.
struct Change {
  Particles<double> before, after;

  Vec3 momentum_gain() const { return linear_momentum(after) - linear_momentum(before); }
  double energy_gain() const { return kinetic_energy(after) - kinetic_energy(before); }
};

Change split_of(Particles<double> coarse, Discretization discretization) {
  Particles<double> fine(Grid::with_nodes(2 * coarse.grid().rows - 1, 2 * coarse.grid().cols - 1));
  test::share_mass(coarse, 0.4, discretization);
  split(coarse, fine);
  test::share_mass(fine, 0.4, discretization);
  return {std::move(coarse), std::move(fine)};
}

Change merge_of(Particles<double> fine, Discretization discretization) {
  Particles<double> coarse(Grid::with_nodes((fine.grid().rows + 1) / 2, (fine.grid().cols + 1) / 2));
  test::share_mass(fine, 0.4, discretization);
  merge(fine, coarse);
  test::share_mass(coarse, 0.4, discretization);
  return {std::move(fine), std::move(coarse)};
}

TEST(SplitMomentum, IsKeptForAnyMotionWithContinuumMasses) {
  // Masses by area make the sum the trapezoid rule, which is exact for the bilinear field that Eq. 8 draws
  // through the coarse nodes: the same at both levels. 289 and 1089 roundings of terms of at most 5 m/s * 0.4
  // kg / 256.
  const Change change =
      split_of(random_state<double>(Grid::with_nodes(17, 17), 20), Discretization::continuum);
  EXPECT_GT(linear_momentum(change.before).norm(), 1e-3);
  EXPECT_LT(change.momentum_gain().norm(), 1e-14);
}

TEST(SplitMomentum, GrowsWithPaperMassesByTheRatioOfTheCounts) {
  // One moving node of 1 m/s, inside: its coarse mass is M/289; split, it and its neighbours carry
  // 1 + 4/2 + 4/4 = 4 m/s of mass M/1089 each. In a corner 1 + 2/2 + 1/4 = 2.25.
  for (const auto& [r, c, sum] : {std::tuple{8, 8, 4.0}, std::tuple{0, 0, 2.25}, std::tuple{0, 5, 3.0}}) {
    Particles<double> coarse = test::flat_sheet<double>(17, 17, {2, 2});
    set(coarse.velocity, r, c, {0, 0, 1});
    const Change change = split_of(coarse, Discretization::paper);
    EXPECT_NEAR(linear_momentum(change.before).z(), 0.4 / 289, 1e-17);
    EXPECT_NEAR(linear_momentum(change.after).z(), 0.4 / 1089 * sum, 1e-17);
  }
}

TEST(SplitMomentum, OfALinearVelocityFieldIsKeptByBoth) {
  // v = a + b u + c v is its own mean: symmetric about the centre, both masses give M (a + b/2 + c/2).
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    Particles<double> coarse = test::flat_sheet<double>(17, 33, {2, 1});
    each_node(coarse.grid(), [&](int r, int c) {
      set(coarse.velocity, r, c, Vec3(1, 2, 3) + c / 32.0 * Vec3(4, 0, -2) + r / 16.0 * Vec3(0, 6, 2));
    });
    const Change change = split_of(coarse, d);
    const Vec3 expected = 0.4 * Vec3(3, 5, 3);
    EXPECT_LT((linear_momentum(change.before) - expected).norm(), 1e-13);
    EXPECT_LT((linear_momentum(change.after) - expected).norm(), 1e-13);
  }
}

TEST(SplitEnergy, FallsByTheVarianceThatAveragingRemoves) {
  // An inside node at 1 m/s alone: fine masses are m/4, squared speeds 1 + 4/4 + 4/16 = 2.25, so 2.25/4 of
  // m/2 stays.
  Particles<double> one = test::flat_sheet<double>(9, 9, {2, 2});
  set(one.velocity, 4, 4, {0, 1, 0});
  const Change single = split_of(one, Discretization::continuum);
  EXPECT_NEAR(kinetic_energy(single.before), 0.5 * 0.4 / 64, 1e-17);
  EXPECT_NEAR(kinetic_energy(single.after) / kinetic_energy(single.before), 0.5625, 1e-14);

  // In general: the trapezoid rule gives |v|^2 of the corners the same weight as its bilinear means, so what
  // is lost is m/2 (mean of |v|^2 - |mean of v|^2) at each new node. Never a gain.
  const Change change =
      split_of(random_state<double>(Grid::with_nodes(9, 17), 21), Discretization::continuum);
  double lost = 0;
  each_node(change.after.grid(), [&](int r, int c) {
    double squares = 0;
    for (int r0 : {r / 2, (r + 1) / 2}) {
      for (int c0 : {c / 2, (c + 1) / 2}) squares += change.before.velocity_at(r0, c0).squaredNorm() / 4;
    }
    lost += change.after.mass.at(r, c) / 2 * (squares - change.after.velocity_at(r, c).squaredNorm());
  });
  EXPECT_GT(lost, 0.1 * kinetic_energy(change.before));  // random motion is mostly variance
  EXPECT_NEAR(change.energy_gain(), -lost, 1e-12);
}

TEST(SplitEnergy, OfAStretchedSheetIsUnchanged) {
  // Eq. 8 adds no membrane energy: a uniformly strained sheet has the same energy per area at both levels.
  Particles<double> coarse = test::flat_sheet<double>(9, 9, Vec2(2.02, 2.06)), fine(Grid::with_nodes(17, 17));
  split(coarse, fine);
  Material material;
  material.bending = 0;
  const Springs<double> before(material, Discretization::continuum, {2, 2}, coarse.grid());
  const Springs<double> after(material, Discretization::continuum, {2, 2}, fine.grid());
  EXPECT_GT(before.energy(coarse.position), 1.0);
  EXPECT_NEAR(after.energy(fine.position) / before.energy(coarse.position), 1.0, 1e-11);
}

TEST(MergeMomentum, ChangesByTheMomentumOfTheDetailDropped) {
  // detail = fine - split(merge(fine)), zero on shared nodes. The rest keeps its momentum (SplitMomentum), so
  // the change is exactly minus the detail's momentum.
  const Change change =
      merge_of(random_state<double>(Grid::with_nodes(17, 33), 22), Discretization::continuum);
  Particles<double> smooth(change.before.grid());
  split(change.after, smooth);
  Vec3 detail = Vec3::Zero();
  each_node(smooth.grid(), [&](int r, int c) {
    detail += change.before.mass.at(r, c) * (change.before.velocity_at(r, c) - smooth.velocity_at(r, c));
  });
  EXPECT_GT(detail.norm(), 1e-3);
  EXPECT_LT((change.momentum_gain() + detail).norm(), 1e-14);
}

TEST(MergeMomentum, WithoutDetailNothingChanges) {
  // A sheet that was just split has no detail: merging gives its momentum back, in both discretizations.
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    const Change there = split_of(random_state<double>(Grid::with_nodes(9, 9), 23), d);
    const Change back = merge_of(there.after, d);
    EXPECT_EQ(linear_momentum(back.after), linear_momentum(there.before));
    EXPECT_EQ(kinetic_energy(back.after), kinetic_energy(there.before));
  }
}

TEST(MergeMomentum, ByFullWeightingIsKeptAndKineticEnergyNeverRises) {
  // Each fine node's momentum is shared out with weights that sum to 1, and the coarse masses are the fine
  // ones shared out likewise: the sum is the same but for 561 roundings. Each coarse velocity is a mean,
  // whose square is at most the mean of the squares.
  Particles<double> fine = random_state<double>(Grid::with_nodes(17, 33), 25);
  test::share_mass(fine, 0.4, Discretization::continuum);
  Particles<double> coarse(Grid::with_nodes(9, 17));
  merge_momentum(fine, coarse);
  test::share_mass(coarse, 0.4, Discretization::continuum);
  EXPECT_GT(linear_momentum(fine).norm(), 1e-3);
  EXPECT_LT((linear_momentum(coarse) - linear_momentum(fine)).norm(), 1e-14);
  EXPECT_LT(kinetic_energy(coarse), kinetic_energy(fine));
}

TEST(MergeMomentum, ByFullWeightingOfAUniformMotionIsExact) {
  Particles<double> fine = test::flat_sheet<double>(9, 17, {2, 2});
  test::share_mass(fine, 0.4, Discretization::continuum);
  each_node(fine.grid(), [&](int r, int c) { set(fine.velocity, r, c, {1, -2, 0.5}); });
  Particles<double> coarse(Grid::with_nodes(5, 9));
  merge_momentum(fine, coarse);
  each_node(coarse.grid(),
            [&](int r, int c) { EXPECT_LT((coarse.velocity_at(r, c) - Vec3(1, -2, 0.5)).norm(), 1e-15); });
}

TEST(MergeEnergy, IsBoundedByTheDetailDropped) {
  // With s = split(merge(v)) and detail d = v - s: KE(after) - KE(before) = [KE(after) - KE(s)] - sum m (s.d
  // + d^2/2). The bracket is the split's loss. A smooth swing plus 1 % of random detail: the change stays
  // below sum m (|s| |d| + |d|^2 / 2) plus the bracket.
  Particles<double> fine = test::flat_sheet<double>(33, 33, {2, 2});
  VectorField<double> noise(fine.grid());
  test::randomise(noise, -0.01, 0.01, 24);
  each_node(fine.grid(), [&](int r, int c) {
    const Vec3 swing(0.0, std::sin(0.1 * r), std::cos(0.1 * c));
    set(fine.velocity, r, c, swing + get(noise, r, c));
  });
  const Change change = merge_of(fine, Discretization::continuum);
  Particles<double> smooth(fine.grid());
  split(change.after, smooth);
  double bound = 0, exact = 0, smooth_energy = 0;
  each_node(fine.grid(), [&](int r, int c) {
    const double m = change.before.mass.at(r, c);
    const Vec3 s = smooth.velocity_at(r, c), d = change.before.velocity_at(r, c) - s;
    bound += m * (s.norm() * d.norm() + d.squaredNorm() / 2);
    exact -= m * (s.dot(d) + d.squaredNorm() / 2);
    smooth_energy += m * s.squaredNorm() / 2;
  });
  const double split_loss = kinetic_energy(change.after) - smooth_energy;
  EXPECT_NEAR(change.energy_gain(), exact + split_loss, 1e-14);
  EXPECT_LE(std::abs(change.energy_gain()), bound + split_loss);
  // And that is little: the noise is 1 % of the speeds, the swing's own curvature loses (0.1)^2/4 of a share.
  EXPECT_LT(std::abs(change.energy_gain()), 0.01 * kinetic_energy(change.before));
}

// A sheet at rest, folded along every second column, its springs as long as they are at rest: no energy at
// all. Taken over by the coarser grid, whose springs have the same constant, 3 x 2 of them lie straight
// across the folds, 0.6 of 0.5 m long: 6 (100 N/m) (0.2 m)^2 / 2 = 12 J, whatever is done about the
// velocities.
TEST(MergeEnergy, FoldsBecomeCompressedSpringsByThePapersRules) {
  Material material;
  material.structural = 100;
  material.shear = material.bending = 0;
  Particles<double> fine(Grid::with_nodes(5, 5)), coarse(Grid::with_nodes(3, 3));
  each_node(fine.grid(),
            [&](int r, int c) { set(fine.position, r, c, 0.25 * Vec3(0.6 * c, -r, c % 2 == 0 ? 0 : 0.8)); });
  merge(fine, coarse);
  const auto energy = [&](const Particles<double>& sheet) {
    return Springs<double>(material, Discretization::paper, {1, 1}, sheet.grid()).energy(sheet.position);
  };
  EXPECT_NEAR(energy(fine), 0, 1e-12);
  EXPECT_NEAR(energy(coarse), 12, 1e-12);
}

}  // namespace
}  // namespace weft
