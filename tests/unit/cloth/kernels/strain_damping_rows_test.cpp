#include "cloth/kernels/strain_damping_rows.h"

#include <gtest/gtest.h>

#include "random_lattice.h"

namespace weft::kernels::strain_damping_rows {
namespace {

using fixture::LatticeSpring;
using fixture::RandomLattice;

constexpr double kDampingFactor = 0.3;

/// What the springs' damping must be, where resisted(spring, d, change) is what it resists, m/s or m.
template <class Resisted>
std::vector<Vec3> listed_damping(const RandomLattice& sheet, Resisted resisted) {
  std::vector<Vec3> forces(sheet.grid.size(), Vec3(0, 0, 0));
  for (const LatticeSpring& spring : sheet.list) {
    const Vec3 d = sheet.difference(sheet.position, spring), u = sheet.difference(sheet.change, spring);
    const Vec3 force = -kDampingFactor * spring.stiffness * resisted(spring, d, u) * d.normalized();
    forces[spring.first] += force;
    forces[spring.second] -= force;
  }
  return forces;
}

template <Damped kDamped, bool kTorn>
void add_damping(RandomLattice& sheet) {
  std::vector<double, AlignedAllocator<double>> work(3 * static_cast<std::size_t>(sheet.grid.stride));
  const Fields<double> fields{sheet.position, sheet.change, sheet.force, work_row(sheet.grid, work.data())};
  add_all<double, kDamped, kTorn>(sheet.springs, sheet.grid, kDampingFactor, fields);
}

double rate_of(const LatticeSpring&, const Vec3& d, const Vec3& u) { return d.normalized().dot(u); }

TEST(StrainDampingRows, TheRateOfEachSpringsLengthIsResisted) {
  RandomLattice whole(false), torn(true);
  add_damping<Damped::rate, false>(whole);
  add_damping<Damped::rate, true>(torn);
  EXPECT_LT(fixture::largest_error(whole.grid, whole.force, listed_damping(whole, rate_of)), 1e-12);
  EXPECT_LT(fixture::largest_error(torn.grid, torn.force, listed_damping(torn, rate_of)), 1e-12);
}

TEST(StrainDampingRows, BeyondLimitsOnlyLongerSpringsAreDamped) {
  RandomLattice sheet(false);
  add_damping<Damped::rate_beyond_limits, false>(sheet);
  const auto expected = listed_damping(sheet, [](const LatticeSpring& spring, const Vec3& d, const Vec3& u) {
    return spring.past(d.norm()) > 0 ? d.normalized().dot(u) : 0.0;
  });
  EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, expected), 1e-12);
}

// By how much the way has made each longer, however far it turned.
TEST(StrainDampingRows, TheGrowthOfEachSpringsLengthIsResisted) {
  RandomLattice sheet(false);
  add_damping<Damped::growth, false>(sheet);
  const auto expected = listed_damping(
      sheet, [](const LatticeSpring&, const Vec3& d, const Vec3& u) { return d.norm() - (d - u).norm(); });
  EXPECT_LT(fixture::largest_error(sheet.grid, sheet.force, expected), 1e-12);
}

// Central and opposite forces that resist the rates of lengths: no sum, no torque, and power is lost.
TEST(StrainDampingRows, MomentaStayAndEnergyIsLost) {
  RandomLattice sheet(false);
  add_damping<Damped::rate, false>(sheet);
  Vec3 sum(0, 0, 0), torque(0, 0, 0);
  double power = 0, size = 0;
  for (int r = 0; r < sheet.grid.rows; ++r) {
    for (int c = 0; c < sheet.grid.cols; ++c) {
      const std::size_t i = sheet.grid.index(r, c);
      const Vec3 force = at<double>(sheet.force, i);
      sum += force;
      torque += at<double>(sheet.position, i).cross(force);
      power += force.dot(at<double>(sheet.change, i));
      size += force.norm();
    }
  }
  EXPECT_LT(sum.norm(), 1e-14 * size);
  EXPECT_LT(torque.norm(), 1e-14 * size);
  EXPECT_LT(power, 0);
}

}  // namespace
}  // namespace weft::kernels::strain_damping_rows
