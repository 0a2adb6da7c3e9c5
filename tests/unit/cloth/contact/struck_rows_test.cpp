#include "cloth/contact/recovery/struck_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>

#include "cloth/kernels/node_kernels.h"
#include "cloth/shapes/triangle_mesh.h"
#include "fixtures.h"
#include "meshes.h"

namespace weft {
namespace {

constexpr int kStruckRows = 20;
const Grid kStruckGrid = Grid::with_nodes(kStruckRows, 30);

/// Nodes at random in a cube of 2 m.
struct Cloud {
  explicit Cloud(std::uint64_t seed) : position(kStruckGrid) { test::randomise(position, -1, 1, seed); }
  kernels::NodeBlock<double> block() const {
    return {kernels::components(position), kStruckRows, kStruckGrid.stride, kStruckGrid.cols};
  }
  VectorField<double> position;
};

/// Bit r where row r has a node of which is_so(row, column).
template <class IsSo>
std::uint32_t rows_where(IsSo is_so) {
  std::uint32_t rows = 0;
  test::each_node(kStruckGrid, [&](int r, int c) {
    if (is_so(r, c)) rows |= std::uint32_t{1} << r;
  });
  return rows;
}

/// Bits of `rows` that are not in `found`.
std::uint32_t missed(std::uint32_t rows, std::uint32_t found) { return rows & ~found; }

PlacedShape placed_shape(const Shape& shape) {
  return {shape, {0.3, -0.2, 0.25}, Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix()};
}

TEST(StruckRows, RowsInsideAreThoseWithANodeInTheShape) {
  for (const Shape& shape :
       {Shape(Sphere{0.3}), Shape(HalfSpace{}), Shape(Capsule{0.3, 0.15}), Shape(Box{{0.4, 0.2, 0.15}})}) {
    PlacedShape placed = placed_shape(shape);
    // Few nodes of any row are below a plane so far out.
    if (std::holds_alternative<HalfSpace>(shape)) placed.centre = -0.85 * placed.rotation.col(1);
    std::uint32_t some = 0;
    bool all = true;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Cloud cloud(seed);
      const std::uint32_t expected =
          rows_where([&](int r, int c) { return placed.contains(test::get(cloud.position, r, c)); });
      EXPECT_EQ(rows_inside(cloud.block(), placed), expected) << shape.index();
      some |= expected;
      all = all && expected == (std::uint32_t{1} << kStruckRows) - 1;
    }
    EXPECT_NE(some, 0U);
    EXPECT_FALSE(all);
  }
}

// A mesh has no kernel of its own: perhaps inside, but none that is is missing.
TEST(StruckRows, OfAMeshNoRowInsideIsMissing) {
  const TriangleMesh surface(test::torus_mesh(0.3, 0.1, 12, 16));
  const PlacedShape placed = placed_shape(Mesh{&surface});
  std::uint32_t some = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Cloud cloud(seed);
    const std::uint32_t inside =
        rows_where([&](int r, int c) { return placed.contains(test::get(cloud.position, r, c)); });
    EXPECT_EQ(missed(inside, rows_inside(cloud.block(), placed)), 0U);
    some |= inside;
  }
  EXPECT_NE(some, 0U);
}

Solid flying_solid(const Shape& shape) {
  Solid solid;
  solid.shape = shape;
  solid.start = {-0.5, 0.2, 0};
  solid.position = {0.4, -0.1, 0.3};
  return solid;
}

// From here to there in a part of the step, its middle's way; one that turns is farther by its outermost
// points' arcs.
TEST(StruckRows, ASweepBoundsTheWayOfEveryPoint) {
  Solid solid = flying_solid(Box{{0.3, 0.2, 0.1}});
  const Substep part{0.25, 0.75, 0.01};
  EXPECT_NEAR(sweep_of(solid, part), 0.5 * (solid.position - solid.start).norm(), 1e-15);
  solid.turn = {0.5, -1, 2};
  double farthest = 0;
  for (const Corner& corner : corners_of(solid.shape)) {
    const PlacedShape was = solid.placed(part.from), is = solid.placed(part.to);
    farthest = std::max(
        farthest, (is.centre + is.rotation * corner.place - was.centre - was.rotation * corner.place).norm());
  }
  EXPECT_LE(farthest, sweep_of(solid, part));
  EXPECT_LT(sweep_of(solid, part), 2 * farthest);
}

TEST(StruckRows, WaysLeadFromPlacesOrByVelocities) {
  const Cloud now(1), before(2);
  const Way<double> to = Way<double>::to(before.position), by = Way<double>::by(before.position, -0.1);
  double longest_to = 0, longest_by = 0;
  test::each_node(kStruckGrid, [&](int r, int c) {
    const Vec3 place = test::get(now.position, r, c), other = test::get(before.position, r, c);
    const std::size_t i = kStruckGrid.index(r, c);
    EXPECT_LT((to.move(place, i) - (place - other)).norm(), 1e-15);
    EXPECT_LT((by.move(place, i) - 0.1 * other).norm(), 1e-15);
    longest_to = std::max(longest_to, (place - other).norm());
    longest_by = std::max(longest_by, 0.1 * other.norm());
  });
  EXPECT_NEAR(to.longest(now.position), longest_to, 1e-14);
  EXPECT_NEAR(by.longest(now.position), longest_by, 1e-14);
}

MovingSolid moving_solid(const Solid& solid, bool fast, double reach = 0) {
  const Substep whole;
  return {&solid,
          solid.placed(1),
          solid.position - solid.start,
          sweep_of(solid, whole),
          reach,
          fast,
          0,
          Vec3(0, 0, 0),
          Vec3(0, 0, 0),
          whole,
          solid.move(0, 1)};
}

// Slow ones strike what they end in. Of fast ones no row with a node whose way, seen from the solid, leads
// through it is missing.
TEST(StruckRows, FastSolidsStrikeWhatTheyPass) {
  const TriangleMesh surface(test::sphere_mesh(0.2, 8, 10));
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Mesh{&surface}), Shape(Capsule{0.2, 0.1})}) {
    const Solid solid = flying_solid(shape);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Cloud now(seed), before(seed + 10);
      const Way<double> way = Way<double>::to(before.position);
      const MovingSolid slow = moving_solid(solid, false);
      const MovingSolid fast = moving_solid(solid, true, way.longest(now.position) + slow.sweep);
      EXPECT_EQ(rows_struck(now.block(), slow, way, 0), rows_inside(now.block(), slow.shape));
      const std::uint32_t passed = rows_where([&](int r, int c) {
        const Vec3 place = test::get(now.position, r, c);
        const Vec3 from = place - way.move(place, kStruckGrid.index(r, c)) + fast.move;
        return fast.shape.contains(from) || fast.shape.contains(place) ||
               fast.shape.first_hit(from, place).has_value();
      });
      EXPECT_NE(passed, 0U);
      EXPECT_EQ(missed(passed, rows_struck(now.block(), fast, way, 0)), 0U) << shape.index();
    }
  }
}

// A ball's rows are those that its kernel finds, not all.
TEST(StruckRows, AFastBallDoesNotStrikeWhatIsFarFromItsWay) {
  const Solid ball = flying_solid(Sphere{0.05});
  VectorField<double> away(kStruckGrid), still(kStruckGrid);
  away.x.fill(3);
  const MovingSolid fast = moving_solid(ball, true);
  const kernels::NodeBlock<double> block{kernels::components(std::as_const(away)), kStruckRows,
                                         kStruckGrid.stride, kStruckGrid.cols};
  EXPECT_EQ(rows_struck(block, fast, Way<double>::by(still, -0.01), 0), 0U);
}

// What went 0.1 m at most may have met what is no farther: of a long capsule and a flat box those rows are
// few, though the balls around them hold most.
TEST(StruckRows, FastSolidsStrikeNoRowThatIsFarFromTheirSurface) {
  for (const Shape& shape : {Shape(Capsule{0.5, 0.05}), Shape(Box{{0.5, 0.02, 0.2}})}) {
    Solid solid = flying_solid(shape);
    solid.start = solid.position - Vec3(0, 0.05, 0);
    const MovingSolid fast = moving_solid(solid, true, 0.1 + sweep_of(solid, {}));
    bool all = true;
    std::uint32_t some = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Cloud now(seed), aside(seed + 10);
      VectorField<double> before = now.position;
      kernels::add_scaled(kernels::components(before), kernels::components(aside.position),
                          0.1 / std::sqrt(3.0), kStruckGrid.size());
      const Way<double> way = Way<double>::to(before);
      const std::uint32_t struck = rows_struck(now.block(), fast, way, 0);
      const std::uint32_t passed = rows_where([&](int r, int c) {
        const Vec3 place = test::get(now.position, r, c);
        const Vec3 from = place - way.move(place, kStruckGrid.index(r, c)) + fast.move;
        return fast.shape.contains(place) || fast.shape.first_hit(from, place).has_value();
      });
      EXPECT_EQ(missed(passed, struck), 0U) << shape.index();
      some |= passed;
      all = all && struck == (std::uint32_t{1} << kStruckRows) - 1;
    }
    EXPECT_NE(some, 0U);
    EXPECT_FALSE(all) << shape.index();
  }
}

// Nodes go `reach` at most, the solid its way: what they can meet on it is found.
TEST(StruckRows, RowsNearAWayHoldAllThatMayMeetTheSolid) {
  Solid solid = flying_solid(Box{{0.15, 0.1, 0.05}});
  const Substep part{0.2, 0.6, 0.01};
  // Turns of 0.9 and 0.18 rad in that part.
  for (const Vec3& turn : {Vec3(0, 2, 1), Vec3(0, 0.4, 0.2)}) {
    solid.turn = turn;
    const PlacedShape end = solid.placed(part.to);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Cloud cloud(seed);
      const std::uint32_t near = rows_near_way(cloud.block(), solid, end, part, 0.05);
      const std::uint32_t may_meet = rows_where([&](int r, int c) {
        for (int i = 0; i <= 8; ++i) {
          const PlacedShape placed = solid.placed(part.from + i / 8.0 * (part.to - part.from));
          if (placed.surface(test::get(cloud.position, r, c)).distance <= 0.05) return true;
        }
        return false;
      });
      EXPECT_NE(may_meet, 0U);
      EXPECT_EQ(missed(may_meet, near), 0U);
    }
    Cloud far(1);
    for (double& x : far.position.x.values()) x += 5;
    EXPECT_EQ(rows_near_way(far.block(), solid, end, part, 0.05), 0U);
  }
}

// Border nodes that two tiles share are visited once, in the tile below or to the right.
TEST(StruckRows, EachNodeOfAStruckRowIsVisitedOnce) {
  const Cloud cloud(1);
  const std::vector<Tile> tiles{{0, 9, 0, 9}, {0, 9, 8, 30}, {8, 20, 0, 9}, {8, 20, 8, 30}};
  // The first tile may touch two solids, the third none.
  const std::vector<TileSolidPair> pairs{{0, 0}, {0, 1}, {1, 1}, {3, 0}};
  ContactCounters counters;
  std::vector<std::size_t> firsts;
  std::multiset<std::pair<int, int>> visited;
  for_each_struck(
      cloud.position, tiles, pairs, counters,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<double>& block, std::size_t first) {
        firsts.push_back(first);
        EXPECT_EQ(block.position.x, cloud.position.x.row(0) + first);
        return pair.tile == 0 ? std::uint32_t{1} << (pair.solid == 0 ? 2 : 5) : std::uint32_t{1};
      },
      [&](int r, int c, std::span<const std::size_t> met) {
        visited.emplace(r, c);
        // Of the two that the first tile may touch each has its own row.
        ASSERT_EQ(met.size(), 1U);
        EXPECT_EQ(met[0], r == 5 || r == 0 ? 1U : 0U);
      });
  EXPECT_EQ(firsts, (std::vector<std::size_t>{0, 0, kStruckGrid.index(0, 8), kStruckGrid.index(8, 8)}));
  std::multiset<std::pair<int, int>> expected;
  for (int c = 0; c < 8; ++c) expected.insert({{2, c}, {5, c}});
  for (int c = 8; c < 30; ++c) expected.insert({{0, c}, {8, c}});
  EXPECT_EQ(visited, expected);
  EXPECT_EQ(counters.tiles_examined, 3U);
  EXPECT_EQ(counters.nodes_tested, 8U * 8 + 8 * 22 + 12 * 22);
}

}  // namespace
}  // namespace weft
