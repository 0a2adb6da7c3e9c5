// Which sheets are moved out of their plane, and how far.
#include <gtest/gtest.h>

#include <limits>

#include "cloth/sheet/planar.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::flat_sheet;
using test::set;

constexpr double kPlaneSheet = 2;  // m

/// A flat sheet of 2 m whose first row's edges are pressed together by this share; in the plane z = 0, or
/// turned into x = 0 or y = 0.
template <class Real>
struct Pressed {
  explicit Pressed(double share, int plane = 2)
      : particles(flat_sheet<Real>(9, 9, {kPlaneSheet, kPlaneSheet})),
        springs(Material{}, Discretization::continuum, {kPlaneSheet, kPlaneSheet}, particles.grid()) {
    each_node(particles.grid(), [&](int r, int c) {
      Vec3 place = particles.local_position_at(r, c);
      if (r == 0) place.x() *= 1 - share;
      const Vec3 turned = plane == 2   ? place
                          : plane == 1 ? Vec3(place.x(), 0, place.y())
                                       : Vec3(0, place.x(), place.y());
      set(particles.position, r, c, turned);
    });
  }
  /// The farthest that any node is moved across the plane, and along it, m.
  std::pair<double, double> left(int plane = 2) {
    const Particles<Real> before = particles;
    leave_plane(springs, particles);
    double across = 0, along = 0;
    each_node(particles.grid(), [&](int r, int c) {
      Vec3 moved = particles.position_at(r, c) - before.position_at(r, c);
      across = std::max(across, std::abs(moved[plane]));
      moved[plane] = 0;
      along = std::max(along, moved.norm());
    });
    return {across, along};
  }
  Particles<Real> particles;
  Springs<Real> springs;
};

// By at most an epsilon of a coordinate as large as the sheet, (9 + 9) cells of 0.25 m, and not along it.
TEST(LeavePlane, ACompressedSheetIsMovedAcrossByRounding) {
  for (const int plane : {0, 1, 2}) {
    const auto [across, along] = Pressed<float>(0.02, plane).left(plane);
    EXPECT_GT(across, 0);
    EXPECT_LE(across, double(std::numeric_limits<float>::epsilon()) * 18 * 0.25);
    EXPECT_EQ(along, 0);
  }
}

TEST(LeavePlane, ASheetThatIsNotCompressedByAPercentStays) {
  for (const double share : {0.0, 0.009, -0.1}) {
    const auto [across, along] = Pressed<double>(share).left();
    EXPECT_EQ(across, 0) << share;
    EXPECT_EQ(along, 0) << share;
  }
  EXPECT_GT(Pressed<double>(0.011).left().first, 0);
}

TEST(LeavePlane, ASheetInNoPlaneStays) {
  Pressed<double> sheet(0.1);
  sheet.particles.position.z.at(4, 4) = 1e-9;
  EXPECT_EQ(sheet.left().first, 0);
}

TEST(LeavePlane, PinnedNodesStay) {
  Pressed<double> sheet(0.1), free(0.1);
  sheet.particles.inverse_mass.at(3, 3) = 0;
  leave_plane(sheet.springs, sheet.particles);
  leave_plane(free.springs, free.particles);
  EXPECT_EQ(sheet.particles.position.z.at(3, 3), 0);
  EXPECT_NE(free.particles.position.z.at(3, 3), 0);
  EXPECT_EQ(sheet.particles.position.z.at(3, 4), free.particles.position.z.at(3, 4));
}

// Nodes that are all in one point have no plane, however pressed.
TEST(LeavePlane, ASheetInOnePointStays) {
  Pressed<double> sheet(0);
  for (auto* field : {&sheet.particles.position.x, &sheet.particles.position.y}) field->fill(0);
  EXPECT_EQ(sheet.left().first, 0);
}

// A sheet that is all on one line leaves it on both sides.
TEST(LeavePlane, ASheetOnOneLineLeavesItBothWays) {
  Pressed<double> sheet(0);
  sheet.particles.position.y.fill(0);
  leave_plane(sheet.springs, sheet.particles);
  EXPECT_NE(sheet.particles.position.y.at(4, 4), 0);
  EXPECT_NE(sheet.particles.position.z.at(4, 4), 0);
}

// What is cut is no edge.
TEST(LeavePlane, TornEdgesDoNotCount) {
  Pressed<double> sheet(0);
  set(sheet.particles.position, 0, 0, sheet.particles.local_position_at(0, 0) + Vec3(0.2, 0, 0));
  set(sheet.particles.position, 1, 0, sheet.particles.local_position_at(1, 0) - Vec3(1, 0, 0));
  Particles<double> whole = sheet.particles;
  leave_plane(sheet.springs, whole);
  EXPECT_NE(whole.position.z.at(4, 4), 0);
  const auto torn = std::make_shared<TornLinks>(sheet.particles.grid());
  torn->cut({0, 0, true});
  sheet.springs.tear(torn);
  EXPECT_EQ(sheet.left().first, 0);
}

}  // namespace
}  // namespace weft
