// A node's stiffness goes from 50 to 5000 times the inertia, by the factors 4 and 0.7 a step (DECISIONS.md).
#include "cloth/contact/constraints/layer_stiffness.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

constexpr std::array<std::size_t, 4> kConstraintsNodes{0, 1, 2, 3};
constexpr std::array<double, 4> kConstraintsWeights{1, -0.5, -0.5, 0};  // the last one is fixed

/// A step in which the constraint keeps this part of its gap.
void end_step(LayerStiffness& stiffness, double part) {
  stiffness.begin_adapting();
  stiffness.keeps(part, kConstraintsNodes, kConstraintsWeights);
  stiffness.adapt();
}

float of_node(const LayerStiffness& stiffness, std::size_t node) {
  return stiffness.of({node, 0, 0, 0}, {1, 0, 0, 0});
}

TEST(LayerStiffness, GrowsWhereTheGapIsHardlyKeptAndFallsWhereItIs) {
  LayerStiffness stiffness(4);
  EXPECT_EQ(of_node(stiffness, 0), 50);
  end_step(stiffness, 0.3);
  EXPECT_EQ(of_node(stiffness, 1), 200);
  EXPECT_EQ(of_node(stiffness, 3), 50) << "a fixed node has no part in it";
  end_step(stiffness, 0.5);
  EXPECT_EQ(of_node(stiffness, 1), 200) << "half kept it stays";
  end_step(stiffness, 0.9);
  EXPECT_FLOAT_EQ(of_node(stiffness, 1), 140);
}

TEST(LayerStiffness, StaysWithinItsBounds) {
  LayerStiffness stiffness(4);
  for (int step = 0; step < 10; ++step) end_step(stiffness, 0);
  EXPECT_EQ(of_node(stiffness, 0), 5000);
  stiffness.stiffen({1, 0, 0, 0});
  EXPECT_EQ(of_node(stiffness, 0), 5000);
  for (int step = 0; step < 50; ++step) end_step(stiffness, 1);
  EXPECT_EQ(of_node(stiffness, 0), 50);
}

// Of two constraints that share a node the one that is pressed further in counts.
TEST(LayerStiffness, TheWorstConstraintOfANodeCounts) {
  LayerStiffness stiffness(4);
  stiffness.begin_adapting();
  stiffness.keeps(0.3, kConstraintsNodes, kConstraintsWeights);
  stiffness.keeps(0.9, kConstraintsNodes, kConstraintsWeights);
  stiffness.adapt();
  EXPECT_EQ(of_node(stiffness, 0), 200);
}

TEST(LayerStiffness, GrowsAtStruckNodesAndWhereItIsAskedTo) {
  LayerStiffness stiffness(4);
  stiffness.begin_adapting();
  stiffness.struck(2);
  stiffness.adapt();
  EXPECT_EQ(of_node(stiffness, 2), 200);
  stiffness.stiffen({0, 0, 1, 0});
  EXPECT_EQ(of_node(stiffness, 2), 800);
  EXPECT_EQ(of_node(stiffness, 1), 50);
  EXPECT_EQ(stiffness.of(kConstraintsNodes, kConstraintsWeights), 800)
      << "a constraint has its stiffest node's";
}

}  // namespace
}  // namespace weft::test
