// Layers that merges have put through each other are led back into their order.
#include "cloth/contact/recovery/layer_order.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

const Vec3 kUp(0, 1, 0);

// One above two others, in the middle between them; it is 3 mm below and is to be 2 mm above: with equal
// masses it rises by 1 / (1 + 1/4 + 1/4) of the 5 mm that lack, and they sink by half of that each.
TEST(LayerOrder, ANodeBelowTheLayerItLayOnComesUpAsTheLayerGoesDown) {
  std::vector<Vec3> x{{0, -0.003, 0}, {-0.1, 0, 0}, {0.1, 0, 0}};
  const OrderedLayers pair{{{0, 1}, {1, -0.5}, {2, -0.5}}, kUp, 0.002};
  EXPECT_TRUE(keep_order(std::vector{pair}, {1, 1, 1}, x));
  EXPECT_NEAR(x[0].y(), -0.003 + 0.005 / 1.5, 1e-15);
  EXPECT_NEAR(x[1].y(), -0.0025 / 1.5, 1e-15);
  EXPECT_EQ(x[1].y(), x[2].y());
  EXPECT_EQ(x[0].x(), 0);
}

TEST(LayerOrder, WhatIsInOrderOrFixedStays) {
  std::vector<Vec3> x{{0, 0.003, 0}, {0, 0, 0}};
  const OrderedLayers above{{{0, 1}, {1, -1}}, kUp, 0.002}, far{{{0, 1}, {1, -1}}, kUp, 0.01};
  EXPECT_FALSE(keep_order(std::vector{above}, {1, 1}, x));
  EXPECT_FALSE(keep_order(std::vector{far}, {0, 0}, x));
  EXPECT_TRUE(keep_order(std::vector{far}, {0, 1}, x));
  EXPECT_EQ(x[0].y(), 0.003);
  EXPECT_NEAR(x[1].y(), -0.007, 1e-15);
}

// Each by turns, until all are.
TEST(LayerOrder, AStackThatLiesUpsideDownIsTurned) {
  std::vector<Vec3> x{{0, 0, 0}, {0, -0.001, 0}, {0, -0.002, 0}};
  const std::vector<OrderedLayers> stack{{{{1, 1}, {0, -1}}, kUp, 0.001}, {{{2, 1}, {1, -1}}, kUp, 0.001}};
  EXPECT_TRUE(keep_order(stack, {1, 1, 1}, x));
  EXPECT_GT(x[1].y() - x[0].y(), 0.00099);
  EXPECT_GT(x[2].y() - x[1].y(), 0.00099);
}

}  // namespace
}  // namespace weft
