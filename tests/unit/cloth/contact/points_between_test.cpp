// Where cloth meets solids between its nodes (points_between).
#include "cloth/contact/search/points_between.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fixtures.h"

namespace weft {
namespace {

/// A flat sheet in the plane z = 0, in 8 x 8 cells of 0.1 m around the origin.
Particles<float> flat() { return test::flat_sheet<float>(9, 9, {0.8, 0.8}); }

Solid solid(const Shape& shape, const Vec3& place) {
  Solid made;
  made.id = 1;
  made.shape = shape;
  made.start = made.position = place;
  return made;
}

std::vector<NearPoint> near(const Particles<float>& particles, const Solid& solid,
                            const TornLinks* torn = nullptr, PointHold hold = PointHold::free) {
  BroadPhase<float> broad(particles.grid());
  const Sweep sweep{1, 1, 0};
  const auto& pairs = broad.find_pairs(particles.position, {solid}, sweep);
  return points_between(particles, particles.position, broad.tiles(), pairs, {solid}, sweep, torn, hold);
}

/// Into how many a cell's side is divided: kCellParts over the smallest step between points.
int parts(const std::vector<NearPoint>& found) {
  int step = kCellParts;
  for (const NearPoint& each : found) {
    const int row = each.point.within / kCellParts, col = each.point.within % kCellParts;
    if (row > 0) step = std::min(step, row);
    if (col > 0) step = std::min(step, col);
  }
  return kCellParts / step;
}

/// Of the cell that begins at node (4, 4).
const Vec3 kMiddle(0.05, -0.05, 0);

}  // namespace

// A hole between points of 0.1 m / n has a radius of 0.0707 m / n; it may have 0.7 of the solid's.
TEST(PointsBetween, AreAsCloseAsTheSolidIsSmall) {
  const Particles<float> particles = flat();
  EXPECT_TRUE(near(particles, solid(Sphere{0.102}, kMiddle)).empty());
  EXPECT_EQ(parts(near(particles, solid(Sphere{0.100}, kMiddle))), 2);
  EXPECT_EQ(parts(near(particles, solid(Sphere{0.051}, kMiddle))), 2);
  EXPECT_EQ(parts(near(particles, solid(Sphere{0.050}, kMiddle))), 4);
  EXPECT_EQ(parts(near(particles, solid(Sphere{0.001}, kMiddle))), 8);
  EXPECT_TRUE(near(particles, solid(HalfSpace{}, kMiddle)).empty());
}

// A body that cloth pushes turns: a board comes edge-on, between two rows of points, whose distance then may
// be its inner radius at most.
TEST(PointsBetween, AreAsCloseAsABodyIsThin) {
  const Particles<float> particles = flat();
  const auto body = [](const Shape& shape) {
    Solid made = solid(shape, kMiddle);
    made.inverse_mass = 1;
    return made;
  };
  EXPECT_TRUE(near(particles, body(Box{{0.3, 0.3, 0.102}})).empty());
  EXPECT_EQ(parts(near(particles, body(Box{{0.3, 0.3, 0.1}}))), 2);
  EXPECT_EQ(parts(near(particles, body(Box{{0.3, 0.3, 0.02}}))), 8);
}

// What a hole has to be smaller than is the second smallest of the sides of a solid that stands firm: a board
// does not fit through by being thin.
TEST(PointsBetween, KnowWhatFitsThrough) {
  const Particles<float> particles = flat();
  EXPECT_TRUE(near(particles, solid(Box{{0.3, 0.3, 0.001}}, kMiddle)).empty());
  EXPECT_FALSE(near(particles, solid(Box{{0.02, 0.02, 0.3}}, kMiddle)).empty());
  EXPECT_FALSE(near(particles, solid(Capsule{0.3, 0.03}, kMiddle)).empty());
}

TEST(PointsBetween, AreFoundOnceAndNearTheSolid) {
  const Particles<float> particles = flat();
  const double radius = 0.06;
  const Vec3 node = particles.local_position_at(5, 5);  // (0.1, -0.1, 0)
  const std::vector<NearPoint> found = near(particles, solid(Sphere{radius}, node));
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
  std::set<std::pair<double, double>> inside;
  for (const NearPoint& each : found) {
    const Vec3 place = ClothPoint<float>(each.point, particles).of(kernels::components(particles.position));
    // A cell that the solid reaches may have points as far beyond as it is wide.
    EXPECT_LT((place - node).norm(), radius + 0.142);
    if ((place - node).norm() < radius)
      inside.insert({std::round(1e3 * place.x()), std::round(1e3 * place.y())});
  }
  // Of the points 0.05 m apart the four next to the node, which is one itself, lie in it.
  EXPECT_EQ(inside, (std::set<std::pair<double, double>>{{50, -100}, {100, -150}, {100, -50}, {150, -100}}));
}

// The sheet's last row and column have no cells of their own.
TEST(PointsBetween, LieOnTheLastEdgesToo) {
  const Particles<float> particles = flat();
  const auto has = [](const std::vector<NearPoint>& found, const PointId& id) {
    return std::any_of(found.begin(), found.end(), [&](const NearPoint& each) { return each.point == id; });
  };
  const Grid& grid = particles.grid();
  const std::vector<NearPoint> found =
      near(particles, solid(Sphere{0.06}, particles.local_position_at(8, 8)));
  EXPECT_TRUE(has(found, {grid.index(8, 7), 4}));
  EXPECT_TRUE(has(found, {grid.index(7, 8), 4 * kCellParts}));
  for (const NearPoint& each : found) EXPECT_FALSE(each.point.node == grid.index(8, 8));
}

// A cell that has lost two of its edges is a hole; so is what is left of its links.
TEST(PointsBetween, AreNotInHoles) {
  const Particles<float> particles = flat();
  TornLinks torn(particles.grid());
  for (int c = 3; c <= 5; ++c) {
    for (int r = 3; r <= 5; ++r) {
      torn.cut({r, c, true});
      torn.cut({r, c, false});
    }
  }
  ASSERT_TRUE(torn.face_torn(4, 4));
  const Solid ball = solid(Sphere{0.03}, kMiddle);
  const auto in_hole = [](const std::vector<NearPoint>& found, const Grid& grid) {
    return std::count_if(found.begin(), found.end(),
                         [&](const NearPoint& each) { return each.point.node == grid.index(4, 4); });
  };
  EXPECT_GT(in_hole(near(particles, ball), particles.grid()), 0);
  EXPECT_EQ(in_hole(near(particles, ball, &torn), particles.grid()), 0);
}

// What hangs on pinned nodes by more than half is theirs.
TEST(PointsBetween, AreOfPinnedOrOfFreeNodes) {
  Particles<float> particles = flat();
  const Solid ball = solid(Sphere{0.05}, kMiddle);
  const std::size_t all = near(particles, ball).size();
  EXPECT_TRUE(near(particles, ball, nullptr, PointHold::pinned).empty());
  for (int c = 0; c < 9; ++c) particles.inverse_mass.at(4, c) = 0;
  const auto pinned = near(particles, ball, nullptr, PointHold::pinned);
  EXPECT_EQ(near(particles, ball).size() + pinned.size(), all);
  EXPECT_FALSE(pinned.empty());
  for (const NearPoint& each : pinned) EXPECT_LT(ClothPoint<float>(each.point, particles).free_part(), 0.5);
}

}  // namespace weft
