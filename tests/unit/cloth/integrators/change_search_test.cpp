// How much of a change is taken: of a flat sheet at rest, a column of which goes sideways. The springs'
// linearisation knows nothing of that, so that all of their energy is its error.
#include "cloth/integrators/change_search.h"

#include "rig.h"

namespace weft::test {
namespace {

/// 2 x 3 nodes 1 m apart with springs along the threads. The middle column goes 1 m sideways.
class SidewaysChange : public ::testing::Test {
 protected:
  SidewaysChange() {
    const Grid& grid = rig.particles.grid();
    copy<double>(kernels::components(std::as_const(rig.particles.position)), nodes.vector(0), grid.size());
    for (int r : {0, 1}) weft::set(nodes.vector(6), grid.index(r, 1), Vec3(0, 0, 1));
  }
  static Rig<double> flat() {
    Material material = without_springs();
    material.structural = 200;
    return {flat_sheet<double>(2, 3, {2, 1}), {2, 1}, material, Discretization::paper, {}, Bdf2Description{}};
  }
  /// What the springs hold when the column has gone this share of its way, J, each by its length.
  double energy(double share) const {
    double sum = 0;
    for (const ListedSpring& spring : list_springs(rig.springs().families(), rig.particles.grid())) {
      const bool turns = (spring.c0 == 1) != (spring.c1 == 1);
      const double length = turns ? std::hypot(spring.rest_length, share) : spring.rest_length;
      sum += spring.stiffness / 2 * std::pow(length - spring.rest_length, 2);
    }
    return sum;
  }
  double taken() { return nodes.vector(6).z[rig.particles.grid().index(0, 1)]; }

  Rig<double> rig = flat();
  Forces<double> forces = rig.forces(0);
  ContactConstraints<double> contacts;
  Multigrid<double> system{rig.particles.grid(), false};
  NodeArrays<double> nodes{rig.particles.grid(), 9};
  ChangeSearch<double> search{{{forces, contacts, system, nodes.vector(0), nodes.vector(3), nodes.vector(6),
                                rig.springs().energy_at_twice(rig.particles.grid())}},
                              nullptr};
};

TEST_F(SidewaysChange, IsTakenWholeWhereItGainsEnough) {
  const double decrease = 2 * energy(1);
  const ChangeReport report = search.take_whole(decrease);
  EXPECT_EQ(taken(), 1);
  EXPECT_NEAR(report.brought_in, energy(1) - decrease, 1e-9);
  EXPECT_NEAR(report.error, energy(1), 1e-9);
}

TEST_F(SidewaysChange, IsTakenWholeEvenIfItBringsInSomeEnergy) {
  const ChangeReport report = search.take_whole(energy(1) / 2);
  EXPECT_EQ(taken(), 1);
  EXPECT_NEAR(report.brought_in, energy(1) / 2, 1e-9);
}

// Ten times of what it should gain, and 1 % of strain on average.
TEST_F(SidewaysChange, IsHalvedWhereItIsWild) {
  constexpr double kDecrease = 0.1;  // J; the whole change brings in 69
  double share = 1, gained = kDecrease;
  while (energy(share) - gained > 10 * gained) {
    share /= 2;
    gained = share * (2 - share) * kDecrease;
  }
  EXPECT_LT(share, 1);
  const ChangeReport report = search.take_whole(kDecrease);
  EXPECT_EQ(taken(), share);
  EXPECT_NEAR(report.brought_in, energy(share) - gained, 1e-9);
}

TEST_F(SidewaysChange, IsSearchedUntilItBringsInNothing) {
  constexpr double kDecrease = 0.1;  // J
  double share = 1;
  while (energy(share) > share * (2 - share) * kDecrease) share /= 2;
  const ChangeReport report = search.take_searched(kDecrease);
  EXPECT_EQ(taken(), share);
  EXPECT_TRUE(report.taken);
  EXPECT_LE(report.brought_in, 0);
}

TEST_F(SidewaysChange, IsDroppedWhereNoShareGains) {
  const ChangeReport report = search.take_searched(0);
  EXPECT_FALSE(report.taken);
  EXPECT_EQ(report.brought_in, 0);
  EXPECT_EQ(taken(), 0);
}

}  // namespace
}  // namespace weft::test
