#include "cloth/kernels/spring_rows.h"

#include <gtest/gtest.h>

#include "random_lattice.h"

namespace weft::kernels::spring_rows {
namespace {

using fixture::LatticeSpring;
using fixture::RandomLattice;

std::vector<Vec3> listed_forces(const RandomLattice& sheet, double excess) {
  std::vector<Vec3> forces(sheet.grid.size(), Vec3(0, 0, 0));
  for (const LatticeSpring& spring : sheet.list) {
    if (spring.family > 1 && spring.family < 4 && !sheet.springs.has_shear) continue;
    if (spring.family > 3 && !sheet.springs.has_bending) continue;
    const Vec3 force = spring.force(sheet.difference(sheet.position, spring), excess);
    forces[spring.first] += force;
    forces[spring.second] -= force;
  }
  return forces;
}

using SpringWork = std::vector<double, AlignedAllocator<double>>;
SpringWork spring_work(const Grid& grid) { return SpringWork(spring_work_size(grid), 0.0); }

// Forces of some 40 N/m times 0.03 m.
constexpr double kForceRounding = 1e-13;

TEST(SpringRows, ForcesAreTheSumOverTheSprings) {
  for (const bool shear : {false, true}) {
    for (const bool bending : {false, true}) {
      RandomLattice sheet(false);
      sheet.springs.has_shear = shear;
      sheet.springs.has_bending = bending;
      SpringWork work = spring_work(sheet.grid);
      add_all<double, false>(sheet.springs, sheet.grid, sheet.position, sheet.force, work.data());
      EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, listed_forces(sheet, 0)), kForceRounding)
          << shear << bending;
    }
  }
}

TEST(SpringRows, LimitedSpringsAreStifferPastTheirLimits) {
  RandomLattice sheet(false);
  SpringWork work = spring_work(sheet.grid);
  add_all<double, true>(sheet.springs, sheet.grid, sheet.position, sheet.force, work.data());
  const std::vector<Vec3> limited = listed_forces(sheet, sheet.springs.excess);
  EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, limited), kForceRounding);
  EXPECT_GT(fixture::largest_error(sheet.grid, sheet.force, listed_forces(sheet, 0)), 0.1);
}

TEST(SpringRows, EachRowOfATornSheetHasItsOwnStiffnesses) {
  RandomLattice sheet(true);
  SpringWork work = spring_work(sheet.grid);
  add_all_rows<double, true, true, true, true>(sheet.springs, sheet.grid, sheet.position, sheet.force,
                                               work.data());
  EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, listed_forces(sheet, sheet.springs.excess)),
            kForceRounding);
}

// Forces are added to what is there, and what work space holds does not count a second time.
TEST(SpringRows, ForcesAreAdded) {
  RandomLattice sheet(false);
  SpringWork work = spring_work(sheet.grid);
  for (int pass = 0; pass < 2; ++pass) {
    add_all<double, false>(sheet.springs, sheet.grid, sheet.position, sheet.force, work.data());
  }
  std::vector<Vec3> twice = listed_forces(sheet, 0);
  for (Vec3& force : twice) force *= 2;
  EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, twice), 2 * kForceRounding);
}

// Eq. 1 between neighbours: 0.5 m too long at 40 N/m along (0.6, 0, 0.8); past 1.3 m three times that again.
TEST(SpringRows, ASpringPullsByItsStretch) {
  const Law<double> law{1, 1.3, 3};
  const Force<double> plain = spring<false>(0.9, 0.0, 1.2, 40.0, law),
                      limited = spring<true>(0.9, 0.0, 1.2, 40.0, law);
  EXPECT_NEAR(plain.x, -0.6 * 40 * 0.5, 1e-13);
  EXPECT_NEAR(plain.z, -0.8 * 40 * 0.5, 1e-13);
  EXPECT_NEAR(limited.x, -0.6 * 40 * (0.5 + 3 * 0.2), 1e-13);
  EXPECT_NEAR(limited.z, -0.8 * 40 * (0.5 + 3 * 0.2), 1e-13);
}

TEST(SpringRows, CoincidentEndsHaveNoForce) {
  const Force<double> none = spring<true>(0.0, 0.0, 0.0, 40.0, Law<double>{1, 1.3, 3});
  EXPECT_EQ(none.x, 0);
  EXPECT_EQ(none.y, 0);
  EXPECT_EQ(none.z, 0);
}

}  // namespace
}  // namespace weft::kernels::spring_rows
