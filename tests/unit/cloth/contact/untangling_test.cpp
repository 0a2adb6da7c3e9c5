#include "cloth/contact/recovery/untangling.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

constexpr double kLongestMove = 0.01;  // m

/// A triangle of some metre in the plane y = 0, and one whose tip hangs through it by `depth` m: its edges to
/// the tip cross. Nodes 0 to 2 and 3 to 5, the tip last, 1 kg each.
struct Tip {
  explicit Tip(double depth) {
    nodes.start = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1.5}, {-0.2, 0.4, 0}, {0.2, 0.4, 0}, {0, -depth, 0}};
    nodes.inverse_mass.assign(6, 1);
  }
  std::vector<Crossing> crossings() const {
    std::vector<Crossing> found;
    if (nodes.start[5].y() >= nodes.start[0].y()) return found;
    // Edges of a lone triangle lie at its rim: beyond them is the same third node.
    found.push_back({{3, 5}, {4, 4}, {0, 1, 2}});
    found.push_back({{4, 5}, {3, 3}, {0, 1, 2}});
    return found;
  }
  std::vector<Vec3> moves() const { return untangling_moves(crossings(), nodes, kLongestMove); }
  LayerNodes nodes;
};

TEST(Untangling, WithoutCrossingsNothingMoves) {
  for (const Vec3& move : Tip(-0.1).moves()) EXPECT_TRUE(move.isZero(0));
}

// The line of crossing is the shorter the less the tip hangs through: it is drawn up, the triangle down.
TEST(Untangling, ATipIsDrawnBackOut) {
  const std::vector<Vec3> moves = Tip(0.05).moves();
  EXPECT_GT(moves[5].y(), 0.1 * kLongestMove);
  for (const std::size_t corner : {0U, 1U, 2U}) EXPECT_LT(moves[corner].y(), 0);
}

TEST(Untangling, MovesAreNoLongerThanTheLongest) {
  Tip tip(0.05);
  std::vector<Crossing> many = tip.crossings();
  for (int i = 0; i < 5; ++i) many.push_back(many.front());
  double longest = 0;
  for (const Vec3& move : untangling_moves(many, tip.nodes, kLongestMove)) {
    longest = std::max(longest, move.norm());
  }
  EXPECT_LE(longest, kLongestMove * (1 + 1e-12));
  EXPECT_GT(longest, 0.1 * kLongestMove);
}

TEST(Untangling, FixedNodesStay) {
  Tip tip(0.05);
  tip.nodes.inverse_mass[5] = tip.nodes.inverse_mass[0] = 0;
  const std::vector<Vec3> moves = tip.moves();
  EXPECT_TRUE(moves[5].isZero(0));
  EXPECT_TRUE(moves[0].isZero(0));
  EXPECT_LT(moves[1].y(), 0);
  EXPECT_GT(moves[3].y(), 0);
}

// What an edge is moved by the triangle gives way against: masses times moves add up to nothing.
TEST(Untangling, ACrossingsMovesKeepTheCentreOfMass) {
  Tip tip(0.05);
  tip.nodes.inverse_mass = {1, 2, 0.5, 3, 1, 0.25};
  const std::vector<Crossing> one{tip.crossings()[0]};
  const std::vector<Vec3> moves = untangling_moves(one, tip.nodes, kLongestMove);
  Vec3 sum(0, 0, 0);
  double size = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    sum += moves[i] / tip.nodes.inverse_mass[i];
    size += moves[i].norm() / tip.nodes.inverse_mass[i];
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(sum.norm(), 1e-14 * size);
}

// Step by step until it is free, without a past and whichever way it came: from above or from below.
TEST(Untangling, RepeatedMovesSetATipFree) {
  for (const double side : {1.0, -1.0}) {
    Tip tip(0.05);
    for (Vec3& place : tip.nodes.start) place.y() *= side;
    int rounds = 0;
    const auto crosses = [&] { return side * (tip.nodes.start[5].y() - tip.nodes.start[0].y()) < 0; };
    while (crosses() && rounds < 40) {
      ++rounds;
      const std::vector<Crossing> found{{{3, 5}, {4, 4}, {0, 1, 2}}, {{4, 5}, {3, 3}, {0, 1, 2}}};
      const std::vector<Vec3> moves = untangling_moves(found, tip.nodes, kLongestMove);
      for (std::size_t i = 0; i < moves.size(); ++i) tip.nodes.start[i] += moves[i];
    }
    EXPECT_FALSE(crosses()) << side;
    EXPECT_LT(rounds, 20);
  }
}

// A triangle that has shrunk to a line says nothing.
TEST(Untangling, ATriangleWithoutAnAreaMovesNothing) {
  Tip tip(0.05);
  tip.nodes.start[2] = tip.nodes.start[1];
  for (const Vec3& move : tip.moves()) EXPECT_TRUE(move.isZero(0));
}

}  // namespace
}  // namespace weft
