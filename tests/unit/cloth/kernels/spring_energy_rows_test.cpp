#include "cloth/kernels/spring_energy_rows.h"

#include <gtest/gtest.h>

#include "random_lattice.h"

namespace weft::kernels::spring_energy_rows {
namespace {

using fixture::LatticeSpring;
using fixture::RandomLattice;

/// What each spring's energy is after the change, less its value, slope and stiffness before it.
SpringModelError listed_model_error(const RandomLattice& sheet, double excess) {
  SpringModelError error;
  for (const LatticeSpring& spring : sheet.list) {
    const Vec3 d = sheet.difference(sheet.position, spring), u = sheet.difference(sheet.change, spring);
    const double along = d.normalized().dot(u), across = u.squaredNorm() - along * along;
    const double model = spring.energy(d, excess) - spring.force(d, excess).dot(u) +
                         (spring.along(d, excess) * along * along + spring.across(d, excess) * across) / 2;
    const double off = spring.energy(d + u, excess) - model;
    error.sum += off;
    error.magnitude += std::abs(off);
    error.largest = std::max(error.largest, std::abs(off));
    const bool newly_past = spring.stiffness > 0 && spring.past(d.norm()) == 0;
    if (excess > 0 && newly_past) {
      error.struck = std::max(error.struck, spring.past((d + u).norm()) / spring.rest_length);
    }
  }
  return error;
}

void expect_same(const SpringModelError& found, const SpringModelError& expected) {
  EXPECT_GT(expected.largest, 0);
  EXPECT_NEAR(found.sum, expected.sum, 1e-12 * expected.magnitude);
  EXPECT_NEAR(found.magnitude, expected.magnitude, 1e-12 * expected.magnitude);
  EXPECT_NEAR(found.largest, expected.largest, 1e-12 * expected.largest);
  EXPECT_NEAR(found.struck, expected.struck, 1e-12 * expected.struck);
}

/// The change, random within 1 m, becomes this share of it.
void scale_change(RandomLattice& sheet, double share) {
  for (double* component : {sheet.change.x, sheet.change.y, sheet.change.z}) {
    for (std::size_t i = 0; i < sheet.grid.size(); ++i) component[i] *= share;
  }
}

TEST(SpringEnergyRows, EnergyIsTheSumOverTheSprings) {
  for (const bool torn : {false, true}) {
    const RandomLattice sheet(torn);
    double expected = 0;
    for (const LatticeSpring& spring : sheet.list) {
      expected += spring.energy(sheet.difference(sheet.position, spring), sheet.springs.excess);
    }
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(energy<double>(sheet.springs, sheet.grid, sheet.position), expected, 1e-13 * expected)
        << torn;
  }
}

// Bending springs count only where the lattice has them, shear springs likewise.
TEST(SpringEnergyRows, FamiliesThatALatticeHasNotDoNotCount) {
  RandomLattice sheet(false);
  sheet.springs.has_shear = sheet.springs.has_bending = false;
  double expected = 0;
  for (const LatticeSpring& spring : sheet.list) {
    if (spring.family > 1) continue;
    expected += spring.energy(sheet.difference(sheet.position, spring), sheet.springs.excess);
  }
  EXPECT_NEAR(energy<double>(sheet.springs, sheet.grid, sheet.position), expected, 1e-13 * expected);
}

// Changes by a fifth of the springs' lengths, and by ten of them.
TEST(SpringEnergyRows, ModelErrorIsWhatValueSlopeAndStiffnessLeave) {
  for (const double share : {0.02, 1.0}) {
    SCOPED_TRACE(share);
    RandomLattice whole(false), torn(true);
    scale_change(whole, share);
    scale_change(torn, share);
    const Fields<double> fields{whole.position, whole.change}, torn_fields{torn.position, torn.change};
    const double excess = whole.springs.excess;
    expect_same(model_error<double, false, false>(whole.springs, whole.grid, fields),
                listed_model_error(whole, 0));
    expect_same(model_error<double, true, false>(whole.springs, whole.grid, fields),
                listed_model_error(whole, excess));
    expect_same(model_error<double, false, true>(torn.springs, torn.grid, torn_fields),
                listed_model_error(torn, 0));
    expect_same(model_error<double, true, true>(torn.springs, torn.grid, torn_fields),
                listed_model_error(torn, excess));
  }
}

// Moved by the same vector everywhere, no spring changes.
TEST(SpringEnergyRows, ACommonMoveIsNoError) {
  RandomLattice sheet(false);
  for (int r = 0; r < sheet.grid.rows; ++r) {
    for (int c = 0; c < sheet.grid.cols; ++c) sheet.change.x[sheet.grid.index(r, c)] = 0.25;
    for (int c = 0; c < sheet.grid.cols; ++c) sheet.change.y[sheet.grid.index(r, c)] = -0.5;
    for (int c = 0; c < sheet.grid.cols; ++c) sheet.change.z[sheet.grid.index(r, c)] = 2;
  }
  const SpringModelError error =
      model_error<double, true, false>(sheet.springs, sheet.grid, {sheet.position, sheet.change});
  EXPECT_EQ(error.magnitude, 0);
  EXPECT_EQ(error.struck, 0);
}

}  // namespace
}  // namespace weft::kernels::spring_energy_rows
