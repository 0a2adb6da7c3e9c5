#include "cloth/kernels/linearise_rows.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "random_lattice.h"

namespace weft::kernels::linearise_rows {
namespace {

using fixture::LatticeSpring;
using fixture::RandomLattice;

/// Room for the links of six families.
struct LinkRoom {
  explicit LinkRoom(const Grid& grid) : numbers(grid, 24) {
    links.has_bending = true;
    int first = 0;
    for (SpringLinks<double>* family : {&links.along_u, &links.along_v, &links.falling, &links.rising,
                                        &links.bending_u, &links.bending_v}) {
      *family = {numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3]};
      of.push_back(*family);
      first += 4;
    }
  }
  /// a I + m m^T of the spring's link.
  Eigen::Matrix3d stiffness(const LatticeSpring& spring) const {
    const SpringLinks<double>& link = of[static_cast<std::size_t>(spring.family)];
    const Vec3 m(link.x[spring.first], link.y[spring.first], link.z[spring.first]);
    return link.a[spring.first] * Eigen::Matrix3d::Identity() + m * m.transpose();
  }
  NodeArrays<double> numbers;
  LinkFamilies<SpringLinks<double>> links;
  std::vector<SpringLinks<double>> of;
};

/// -dF/dd by central differences.
Eigen::Matrix3d measured_stiffness(const LatticeSpring& spring, const Vec3& d, double excess) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d stiffness;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = kStep * Vec3::Unit(i);
    stiffness.col(i) = (spring.force(d - step, excess) - spring.force(d + step, excess)) / (2 * kStep);
  }
  return stiffness;
}

/// Whether it is so far from rest and limit that the difference's ends lie on one side of each.
bool is_clear(const LatticeSpring& spring, double length) {
  return std::abs(length - spring.rest_length) > 1e-5 && std::abs(length - spring.limit_length) > 1e-5;
}

// Stretched springs have their true stiffness. That of compressed ones is theirs along the spring, nothing
// across it.
TEST(LineariseRows, LinksAreTheSpringsStiffness) {
  RandomLattice sheet(false);
  LinkRoom room(sheet.grid);
  linearise<double, true, false>(sheet.springs, sheet.grid, sheet.position, 1.0, room.links,
                                 {0, sheet.grid.rows});
  int stretched = 0, compressed = 0;
  for (const LatticeSpring& spring : sheet.list) {
    const Vec3 d = sheet.difference(sheet.position, spring), n = d.normalized();
    if (!is_clear(spring, d.norm())) continue;
    const Eigen::Matrix3d found = room.stiffness(spring),
                          measured = measured_stiffness(spring, d, sheet.springs.excess);
    if (d.norm() > spring.rest_length) {
      EXPECT_LT((found - measured).norm(), 1e-5 * measured.norm());
      ++stretched;
    } else {
      EXPECT_NEAR(n.dot(found * n), n.dot(measured * n), 1e-6 * spring.stiffness);
      EXPECT_LT((found - n.dot(found * n) * n * n.transpose()).norm(), 1e-12 * spring.stiffness);
      ++compressed;
    }
    const Vec3 values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(found).eigenvalues();
    EXPECT_GT(values.minCoeff(), -1e-12 * spring.stiffness);
  }
  EXPECT_GT(stretched, 100);
  EXPECT_GT(compressed, 100);
}

// `axial` times the stiffness along the spring, the tension's across it as before.
TEST(LineariseRows, AxialScalesWhatIsAlongTheSpring) {
  RandomLattice sheet(true);
  LinkRoom room(sheet.grid);
  linearise<double, false, true>(sheet.springs, sheet.grid, sheet.position, 2.5, room.links,
                                 {0, sheet.grid.rows});
  for (const LatticeSpring& spring : sheet.list) {
    const Vec3 d = sheet.difference(sheet.position, spring), n = d.normalized();
    const Eigen::Matrix3d line = n * n.transpose();
    const Eigen::Matrix3d expected =
        2.5 * spring.stiffness * line + spring.across(d, 0) * (Eigen::Matrix3d::Identity() - line);
    EXPECT_LT((room.stiffness(spring) - expected).norm(), 1e-11);
  }
}

TEST(LineariseRows, OnlyTheRowsAskedForAreWritten) {
  RandomLattice sheet(false);
  LinkRoom all(sheet.grid), part(sheet.grid);
  linearise<double, false, false>(sheet.springs, sheet.grid, sheet.position, 1.0, all.links,
                                  {0, sheet.grid.rows});
  linearise<double, false, false>(sheet.springs, sheet.grid, sheet.position, 1.0, part.links, {2, 4});
  for (const LatticeSpring& spring : sheet.list) {
    const int row = static_cast<int>(spring.first) / sheet.grid.stride;
    const Eigen::Matrix3d found = part.stiffness(spring);
    if (row == 2 || row == 3) {
      EXPECT_EQ(found, all.stiffness(spring));
    } else {
      EXPECT_TRUE(found.isZero(0));
    }
  }
}

TEST(LineariseRows, CoincidentEndsAreHeldByNothing) {
  RandomLattice sheet(false);
  const LatticeSpring& spring = sheet.list.front();
  for (double* component : {sheet.position.x, sheet.position.y, sheet.position.z}) {
    component[spring.second] = component[spring.first];
  }
  LinkRoom room(sheet.grid);
  linearise<double, false, false>(sheet.springs, sheet.grid, sheet.position, 1.0, room.links,
                                  {0, sheet.grid.rows});
  EXPECT_TRUE(room.stiffness(spring).isZero(0));
}

}  // namespace
}  // namespace weft::kernels::linearise_rows
