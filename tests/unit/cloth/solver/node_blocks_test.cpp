#include "cloth/kernels/node_blocks.h"

#include <gtest/gtest.h>

namespace weft::kernels {
namespace {

TEST(NodeBlocks, AreInverted) {
  // 4 I + m m^T with m = (1, 2, 3): by Sherman and Morrison the inverse is I / 4 - m m^T / (16 + 4 m.m), 72.
  const Block<double> m{5, 2, 3, 8, 6, 13};
  const Block<double> inverse = inverted(m, 4.0, 1.0, 1.0 / 26);
  EXPECT_NEAR(inverse.xx, 0.25 - 1.0 / 72, 1e-15);
  EXPECT_NEAR(inverse.xy, -2.0 / 72, 1e-15);
  EXPECT_NEAR(inverse.xz, -3.0 / 72, 1e-15);
  EXPECT_NEAR(inverse.yy, 0.25 - 4.0 / 72, 1e-15);
  EXPECT_NEAR(inverse.yz, -6.0 / 72, 1e-15);
  EXPECT_NEAR(inverse.zz, 0.25 - 9.0 / 72, 1e-15);
}

// What is left of a stiff thread's block when rounding has made of it the negative of one: bounded, positive
// definite.
TEST(NodeBlocks, ThatRoundingHasEatenGiveTheSafeInverse) {
  for (const float lost : {1e3F, 1e9F, 1e15F, 1e30F}) {
    const Block<float> m{-lost, lost, lost, -lost, lost, -lost};
    const Block<float> inverse = inverted(m, 1.7F, 0.5F, 1e-6F);
    for (const float number : {inverse.xx, inverse.yy, inverse.zz}) EXPECT_FLOAT_EQ(number, 0.5e-6F);
    for (const float number : {inverse.xy, inverse.xz, inverse.yz}) EXPECT_EQ(number, 0);
  }
}

}  // namespace
}  // namespace weft::kernels
