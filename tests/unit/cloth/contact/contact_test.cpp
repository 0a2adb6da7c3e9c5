// Section 2.4, second half: pushed back to the surface, the velocity into the ball lost, only struck tiles
// looked at.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "cloth/contact/recovery/contact.h"
#include "cloth/contact/search/broad_phase.h"
#include "cloth/shapes/solid.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/colliders.h"
#include "fixtures.h"
#include "loose_contact.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

Solid solid_ball(const Vec3& centre, double radius) {
  Solid ball;
  ball.id = 1;
  ball.shape = Sphere{radius};
  ball.position = ball.start = centre;
  return ball;
}

double radius_of(const Solid& ball) { return std::get<Sphere>(ball.shape).radius; }

/// Nodes inside the ball by more than `slack`, in m.
template <class Real>
int nodes_inside(const Particles<Real>& particles, const Solid& ball, double slack) {
  int count = 0;
  each_node(particles.grid(), [&](int r, int c) {
    count += (particles.position_at(r, c) - ball.position).norm() < radius_of(ball) - slack ? 1 : 0;
  });
  return count;
}

template <class Real>
class Contacts : public ::testing::Test {
 public:
  /// Lengths here are about 1 m.
  static constexpr double kRounding = 8 * double(std::numeric_limits<Real>::epsilon());
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Contacts, Scalars);

TEST(Colliders, ABallIsJustPutForOneStep) {
  Colliders colliders({BallDescription{}});
  for (const bool just_put : {true, false, false}) {
    colliders.begin_step(0, 0.1, Vec3::Zero());
    EXPECT_EQ(colliders.solids()[0].just_put, just_put);
    colliders.end_step();
  }
}

TYPED_TEST(Contacts, PushesANodeBackToTheSurfaceAndTakesTheVelocityIntoTheBall) {
  // Node (4,4) of a flat sheet lies in its middle. The ball's centre is 0.3 m below it along (0,3,4)/5 turned
  // around: outward normal n = (0, 0.6, 0.8). v = (1,0,0) + 2 t - 3 n with t = (0, 0.8, -0.6): only -3 n
  // goes.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  const Vec3 n(0, 0.6, 0.8), t(0, 0.8, -0.6), along(1, 0, 0);
  set(sheet.velocity, 4, 4, along + 2 * t - 3 * n);
  std::vector<Solid> balls{solid_ball(-0.3 * n, 0.5)};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), 1);
  EXPECT_LT((sheet.position_at(4, 4) - 0.2 * n).norm(), this->kRounding);  // centre + 0.5 n
  EXPECT_LT((sheet.velocity_at(4, 4) - (along + 2 * t)).norm(), 4 * this->kRounding);
}

TYPED_TEST(Contacts, KeepsAVelocityThatAlreadyLeaves) {
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.velocity, 4, 4, {0.25, -0.5, 3});
  std::vector<Solid> balls{solid_ball({0, 0, -0.25}, 0.5)};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), 1);
  EXPECT_EQ(sheet.velocity_at(4, 4), Vec3(0.25, -0.5, 3));
  EXPECT_NEAR(sheet.position_at(4, 4).z(), 0.25, this->kRounding);
}

TYPED_TEST(Contacts, FrictionHoldsAPressedNodeWhereItIs) {
  // At rest on a ball of 0.3 m, 30 degrees from its top, pressed 1 mm deep and pulled 0.4 mm along in every
  // substep, less than 0.5 of the depth. Led back along the tangent plane at its deepest place it would climb
  // by 0.4 mm x 1 mm / 0.3 m = 1.3 um in each, 1.3 mm in 1,000. Each substep may round.
  constexpr int kSubsteps = 1000;
  constexpr double kSeconds = 1e-3;
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  const Vec3 n(0.5, 0, std::sqrt(0.75)), down(std::sqrt(0.75), 0, -0.5), rest = 0.3 * n;
  set(sheet.position, 4, 4, rest);
  std::vector<Solid> balls{solid_ball({0, 0, 0}, 0.3)};
  balls[0].friction = 0.5;
  test::LooseContact<TypeParam> contact(sheet.grid());
  for (int i = 0; i < kSubsteps; ++i) {
    const Vec3 pulled = -1e-3 * n + 0.4e-3 * down;
    set(sheet.velocity, 4, 4, pulled / kSeconds);
    set(sheet.position, 4, 4, sheet.position_at(4, 4) + pulled);
    ASSERT_EQ(contact.resolve(sheet, balls, {0, 1, kSeconds}), 1);
    EXPECT_LT(sheet.velocity_at(4, 4).norm(), this->kRounding);
  }
  EXPECT_LT((sheet.position_at(4, 4) - rest).norm(), kSubsteps * this->kRounding / 8);
}

TYPED_TEST(Contacts, TheVelocityThatCountsIsRelativeToTheBall) {
  // A resting node before a ball that comes up at 2 m/s: 2 m/s into the ball, so it leaves with the ball.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.velocity, 4, 4, {0.5, 0, 0});
  std::vector<Solid> balls{solid_ball({0, 0, -0.25}, 0.5)};
  balls[0].velocity = {0, 0, 2};
  test::LooseContact<TypeParam> contact(sheet.grid());
  contact.resolve(sheet, balls, {0.0, 1.0});
  EXPECT_LT((sheet.velocity_at(4, 4) - Vec3(0.5, 0, 2)).norm(), 4 * this->kRounding);
  // A node that outruns the ball keeps its speed.
  set(sheet.position, 4, 4, {0, 0, 0});
  set(sheet.velocity, 4, 4, {0, 0, 3});
  contact.resolve(sheet, balls, {0.0, 1.0});
  EXPECT_EQ(sheet.velocity_at(4, 4), Vec3(0, 0, 3));
}

TYPED_TEST(Contacts, UsesTheBallWhereItIsAtTheSubstepsEnd) {
  // From z = -2 m to 0 in the step: at half of it, -1 m, the ball of 0.9 m does not yet touch the sheet.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  std::vector<Solid> balls{solid_ball({0, 0, 0}, 0.9)};
  balls[0].start = {0, 0, -2};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 0.5}), 0);
  EXPECT_EQ(sheet.position_at(4, 4), Vec3(0, 0, 0));
  EXPECT_EQ(contact.resolve(sheet, balls, {0.5, 0.75}), 1);  // -0.5 m: the node goes to z = 0.4
  EXPECT_NEAR(sheet.position_at(4, 4).z(), 0.4, this->kRounding);
}

TYPED_TEST(Contacts, APinnedNodeStays) {
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  sheet.inverse_mass.at(4, 4) = 0;
  std::vector<Solid> balls{solid_ball({0, 0, -0.25}, 0.5)};
  balls[0].inverse_mass = 1;
  balls[0].velocity = {0, 0, 2};
  test::LooseContact<TypeParam> contact(sheet.grid());
  contact.resolve(sheet, balls, {0.0, 1.0});
  EXPECT_EQ(sheet.position_at(4, 4), Vec3(0, 0, 0));
  EXPECT_EQ(sheet.velocity_at(4, 4), Vec3(0, 0, 0));
  EXPECT_EQ(balls[0].velocity, Vec3(0, 0, 2));
}

TYPED_TEST(Contacts, ANodeAtTheBallsCentreLeavesUpwards) {
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.velocity, 4, 4, {1, -4, 0});
  std::vector<Solid> balls{solid_ball({0, 0, 0}, 0.5)};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), 1);
  EXPECT_LT((sheet.position_at(4, 4) - Vec3(0, 0.5, 0)).norm(), this->kRounding);
  EXPECT_LT((sheet.velocity_at(4, 4) - Vec3(1, 0, 0)).norm(), this->kRounding);
}

TYPED_TEST(Contacts, LeavesNoNodeInsideTheBall) {
  // A sheet crumpled into a 2 m box around a ball of 0.7 m; a rounding of its radius is all that may be
  // missing.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(65, 65, {2, 2});
  test::randomise(sheet.position, -1, 1, 1);
  std::vector<Solid> balls{solid_ball({0.1, -0.05, 0.02}, 0.7)};
  const int inside = nodes_inside(sheet, balls[0], 0);
  ASSERT_GT(inside, 500);
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), inside);
  EXPECT_EQ(nodes_inside(sheet, balls[0], this->kRounding), 0);
  EXPECT_EQ(contact.counters().nodes_in_contact, std::uint64_t(inside));
}

TYPED_TEST(Contacts, LeavesNoNodeInsideTheBallWherePointsBetweenThemMeetItToo) {
  // The same sheet, whose cells are drawn out to more than the ball is wide.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(65, 65, {2, 2});
  test::randomise(sheet.position, -1, 1, 1);
  std::vector<Solid> balls{solid_ball({0.1, -0.05, 0.02}, 0.7)};
  const int inside = nodes_inside(sheet, balls[0], 0);
  Contact<TypeParam> contact(sheet.grid());
  EXPECT_GT(contact.resolve(sheet, balls, {0.0, 1.0}), inside);
  EXPECT_EQ(nodes_inside(sheet, balls[0], this->kRounding), 0);
}

TYPED_TEST(Contacts, TwoBallsPushTheirOwnNodes) {
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});  // nodes 1 m apart
  std::vector<Solid> balls{solid_ball({-2, 0, -0.25}, 0.5), solid_ball({2, 1, 0.25}, 0.5)};
  balls[1].id = 2;
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), 2);
  EXPECT_NEAR(sheet.position_at(4, 2).z(), 0.25, this->kRounding);   // x = -2, y = 0
  EXPECT_NEAR(sheet.position_at(3, 6).z(), -0.25, this->kRounding);  // x = 2, y = 1
}

TYPED_TEST(Contacts, NodesThatTilesShareAreResolvedOnce) {
  // 17 x 17 nodes make 2 x 2 tiles of 8 x 8 cells that share node (8,8): it gives its momentum to the ball
  // once.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(17, 17, {16, 16});
  sheet.mass.fill(TypeParam(0.5));
  sheet.inverse_mass.fill(2);
  set(sheet.velocity, 8, 8, {0, 0, -4});
  std::vector<Solid> balls{solid_ball({0, 0, -0.25}, 0.5)};
  balls[0].inverse_mass = 2;
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, balls, {0.0, 1.0}), 1);
  EXPECT_EQ(contact.counters().nodes_in_contact, 1u);
  // Plastic, 0.5 kg each: both have half of its 4 m/s.
  EXPECT_NEAR(balls[0].velocity.z(), -2.0, this->kRounding);
  EXPECT_NEAR(sheet.velocity_at(8, 8).z(), -2.0, this->kRounding);
}

TYPED_TEST(Contacts, TheBallGetsTheMomentumTheClothLoses) {
  constexpr double kMass = 0.5;
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(33, 33, {2, 2});
  test::share_mass(sheet, 0.4, Discretization::continuum);
  test::randomise(sheet.velocity, -3, 3, 2);
  std::vector<Solid> balls{solid_ball({0.1, 0.1, -0.2}, 0.5)};
  balls[0].inverse_mass = 1 / kMass;
  balls[0].velocity = {0, 1, 2};
  const Vec3 before = linear_momentum(sheet) + kMass * balls[0].velocity;
  test::LooseContact<TypeParam> contact(sheet.grid());
  ASSERT_GT(contact.resolve(sheet, balls, {0.0, 1.0}), 50);
  EXPECT_GT((balls[0].velocity - Vec3(0, 1, 2)).norm(), 0.01 / kMass);
  EXPECT_LT((linear_momentum(sheet) + kMass * balls[0].velocity - before).norm(), 4 * this->kRounding);
}

// --- What is found and left where it is ---

TYPED_TEST(Contacts, InsideADynamicBallIsAsThatIsAtTheSubstepsEnd) {
  // A ball of 0.5 m on its way up from z = -2 m to -0.25 m: node (4,4) at the origin is in it at the step's
  // end, and not before 6 / 7 of its way.
  const Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  std::vector<Solid> balls{solid_ball({0, 0, -0.25}, 0.5)};
  balls[0].start = {0, 0, -2};
  balls[0].inverse_mass = 1;
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.inside(sheet, balls, {0, 0.75, 0.01}), std::vector<Touch>{});
  const Touch touch{sheet.grid().index(4, 4), balls[0].id};
  EXPECT_EQ(contact.inside(sheet, balls, {0.75, 1, 0.01}), std::vector<Touch>{touch});
  EXPECT_EQ(contact.counters().nodes_in_contact, 0U) << "it resolves nothing";
}

TYPED_TEST(Contacts, InsideASmallBallIsAPointBetweenNodes) {
  // In the middle of a cell that is wider than the ball, 4 / 8 along either side.
  const Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  const Vec3 middle = (sheet.local_position_at(4, 4) + sheet.local_position_at(5, 5)) / 2;
  std::vector<Solid> balls{solid_ball(middle, 0.05)};
  balls[0].inverse_mass = 1;
  Contact<TypeParam> contact(sheet.grid());
  const Touch touch{sheet.grid().index(4, 4), balls[0].id, 4 * kCellParts + 4};
  EXPECT_EQ(contact.inside(sheet, balls, {0, 1, 0.01}), std::vector<Touch>{touch});
  balls[0].position = balls[0].start = middle + Vec3(0, 0, 0.06);
  EXPECT_EQ(contact.inside(sheet, balls, {0, 1, 0.01}), std::vector<Touch>{});
}

TYPED_TEST(Contacts, ExpectedAreFreeNodesInWhatStandsFirm) {
  // Each ball's top is 0.1 m below a node: v = -8 m/s takes one 0.08 m down in 10 ms, with a = -300 m/s2
  // 0.03 m farther, in. So it does over a ball that yields; alone it does not over another that stands firm,
  // and a pinned node goes nowhere.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  std::vector<Solid> balls;
  for (const int col : {1, 3, 5, 7}) {
    balls.push_back(solid_ball(sheet.local_position_at(4, col) - Vec3(0, 0, 0.3), 0.2));
    balls.back().id = static_cast<ColliderId>(balls.size());
    set(sheet.velocity, 4, col, {0, 0, -8});
    set(sheet.acceleration, 4, col, {0, 0, -300});
  }
  balls[1].inverse_mass = 1;
  set(sheet.acceleration, 4, 5, {0, 0, 0});
  sheet.inverse_mass.at(4, 7) = 0;
  test::LooseContact<TypeParam> contact(sheet.grid());
  const Touch touch{sheet.grid().index(4, 1), balls[0].id};
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(contact.expect(sheet, balls, {0, 1, 0.01}), std::vector<Touch>{touch}) << "once each";
}

// --- Only struck tiles are looked at ---

TYPED_TEST(Contacts, TilesFarFromTheBallAreNeverExamined) {
  // 65 x 65 nodes on 2 m x 2 m: 8 x 8 tiles of 8 cells, 0.25 m wide. A ball of 0.05 m in the middle of one
  // tile, just touching the sheet's plane, lies 0.075 m from that tile's edge: one tile of 64, 9 x 9 of 4225
  // nodes.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(65, 65, {2, 2});
  std::vector<Solid> balls{solid_ball({0.125, 0.125, 0.04}, 0.05)};
  test::LooseContact<TypeParam> contact(sheet.grid());
  ASSERT_EQ(contact.broad_phase().tiles().size(), 64u);
  contact.resolve(sheet, balls, {0.0, 1.0});
  EXPECT_EQ(contact.counters().tiles_examined, 1u);
  EXPECT_GT(contact.counters().nodes_tested, 0u);
  EXPECT_LE(contact.counters().nodes_tested, 81u);

  // Over a corner of four tiles: four more.
  balls[0] = solid_ball({0.25, 0.25, 0.04}, 0.05);
  contact.resolve(sheet, balls, {0.0, 1.0});
  EXPECT_EQ(contact.counters().tiles_examined, 1u + 4u);

  // Out of reach: none, however often.
  balls[0] = solid_ball({0, 0, 0.5}, 0.05);
  const std::uint64_t tested = contact.counters().nodes_tested;
  for (int i = 0; i < 100; ++i) contact.resolve(sheet, balls, {i / 100.0, (i + 1) / 100.0});
  EXPECT_EQ(contact.counters().tiles_examined, 5u);
  EXPECT_EQ(contact.counters().nodes_tested, tested);
}

// --- The broad phase alone ---

/// The pairs by the plain definition: the box of a tile's nodes meets the box of the ball along its way.
template <class Real>
std::vector<TileSolidPair> overlaps(const std::vector<Tile>& tiles, const VectorField<Real>& position,
                                    const std::vector<Solid>& balls, double from, double to) {
  std::vector<TileSolidPair> pairs;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    Eigen::AlignedBox3d box;
    for (int r = tiles[tile].row_begin; r < tiles[tile].row_end; ++r) {
      for (int c = tiles[tile].col_begin; c < tiles[tile].col_end; ++c) box.extend(get(position, r, c));
    }
    for (std::size_t ball = 0; ball < balls.size(); ++ball) {
      const Vec3 reach = Vec3::Constant(radius_of(balls[ball])), a = balls[ball].at(from),
                 b = balls[ball].at(to);
      const Eigen::AlignedBox3d swept(Vec3(a.cwiseMin(b) - reach), Vec3(a.cwiseMax(b) + reach));
      if (box.intersects(swept)) pairs.push_back({int(tile), int(ball)});
    }
  }
  return pairs;
}

template <class Real>
class BroadPhasePairs : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhasePairs, Scalars);

TYPED_TEST(BroadPhasePairs, TilesCoverTheGridAndShareTheirBorders) {
  // 17 x 27 nodes: 16 x 26 cells, so 2 x 4 tiles, the last column of tiles 2 cells wide.
  const Grid grid = Grid::with_nodes(17, 27);
  const BroadPhase<TypeParam> broad_phase(grid);
  ASSERT_EQ(broad_phase.tiles().size(), 8u);
  std::vector<int> covered(std::size_t(grid.cells()), 0);
  for (const Tile& tile : broad_phase.tiles()) {
    EXPECT_LE(tile.row_end - tile.row_begin - 1, kTileCells);
    EXPECT_LE(tile.col_end - tile.col_begin - 1, kTileCells);
    for (int r = tile.row_begin; r + 1 < tile.row_end; ++r) {
      for (int c = tile.col_begin; c + 1 < tile.col_end; ++c) ++covered[std::size_t(r * (grid.cols - 1) + c)];
    }
  }
  for (int times : covered) EXPECT_EQ(times, 1);
}

TYPED_TEST(BroadPhasePairs, AreThoseOfTheBoxesThatOverlap) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> place(-1.5, 1.5), size(0.01, 0.4);
  const auto point = [&] {
    const double x = place(random), y = place(random), z = place(random);
    return Vec3(x, y, z);
  };
  const Grid grid = Grid::with_nodes(33, 49);
  BroadPhase<TypeParam> broad_phase(grid);
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    // A wavy sheet somewhere, and up to five balls on their way.
    Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(33, 49, {2, 2});
    const Vec3 shift = 0.3 * point();
    each_node(grid, [&](int r, int c) {
      set(sheet.position, r, c,
          sheet.position_at(r, c) + shift + Vec3(0, 0, 0.2 * std::sin(0.3 * r + 0.2 * c + trial)));
    });
    std::vector<Solid> balls(std::size_t(trial % 6));
    for (Solid& ball : balls) {
      ball = solid_ball(point(), size(random));
      ball.start = point();
    }
    const double from = trial % 4 / 4.0, to = from + 0.25;
    const auto expected = overlaps(broad_phase.tiles(), sheet.position, balls, from, to);
    const auto& pairs = broad_phase.find_pairs(sheet.position, balls, {from, to});
    ASSERT_EQ(pairs.size(), expected.size()) << "trial " << trial;
    for (std::size_t i = 0; i < pairs.size(); ++i) {  // ordered by tile, then ball
      EXPECT_EQ(pairs[i].tile, expected[i].tile);
      EXPECT_EQ(pairs[i].solid, expected[i].solid);
    }
    found += pairs.size();
  }
  EXPECT_GT(found, 500u);
}

TYPED_TEST(BroadPhasePairs, SeeAFastBallAllAlongItsWay) {
  // From 5 m before the sheet to 5 m behind it in one step: neither end touches, the way between does.
  const Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(65, 65, {2, 2});
  std::vector<Solid> balls{solid_ball({0.125, 0.125, -5}, 0.05)};
  BroadPhase<TypeParam> broad_phase(sheet.grid());
  EXPECT_TRUE(broad_phase.find_pairs(sheet.position, balls, {0, 1}).empty());
  balls[0].start = {0.125, 0.125, 5};
  EXPECT_EQ(broad_phase.find_pairs(sheet.position, balls, {0, 1}).size(), 1u);
  EXPECT_TRUE(broad_phase.find_pairs(sheet.position, balls, {0, 0.25}).empty());  // still 2.5 m away
}

TYPED_TEST(BroadPhasePairs, FollowBallsThatComeAndGo) {
  const Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(17, 17, {2, 2});
  BroadPhase<TypeParam> broad_phase(sheet.grid());
  std::vector<Solid> balls;
  EXPECT_TRUE(broad_phase.find_pairs(sheet.position, balls, {0, 1}).empty());
  balls = {solid_ball({-0.5, 0.5, 0}, 0.1), solid_ball({0.5, 0.5, 0}, 0.1), solid_ball({0.5, -0.5, 0}, 0.1)};
  EXPECT_EQ(broad_phase.find_pairs(sheet.position, balls, {0, 1}).size(), 3u);
  balls.erase(balls.begin());
  const auto& pairs = broad_phase.find_pairs(sheet.position, balls, {0, 1});
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].tile, 1);  // top right; now the first ball
  EXPECT_EQ(pairs[0].solid, 0);
  EXPECT_EQ(pairs[1].tile, 3);
  EXPECT_EQ(pairs[1].solid, 1);
  balls.clear();
  EXPECT_TRUE(broad_phase.find_pairs(sheet.position, balls, {0, 1}).empty());
}

}  // namespace
}  // namespace weft
