// Parts of a step.
#include "cloth/core/substep.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

TEST(Substep, PartsFollowOneAnotherAndMakeTheStep) {
  constexpr int kParts = 3;
  double end = 0, seconds = 0;
  for (int i = 0; i < kParts; ++i) {
    const Substep part = Substep::of(i, kParts, 0.06);
    EXPECT_EQ(part.from, end) << "without a gap, to the bit";
    EXPECT_DOUBLE_EQ(part.seconds, 0.02);
    EXPECT_DOUBLE_EQ(part.step_seconds(), 0.06);
    end = part.to;
    seconds += part.seconds;
  }
  EXPECT_EQ(end, 1);
  EXPECT_DOUBLE_EQ(seconds, 0.06);
}

TEST(Substep, AMomentTellsTheSecondsOfItsStep) { EXPECT_EQ((Substep{0.5, 0.5, 0.1}.step_seconds()), 0.1); }

}  // namespace
}  // namespace weft::test
