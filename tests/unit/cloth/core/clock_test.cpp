#include "cloth/core/clock.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(Clock, DurationsAreToldInSeconds) {
  EXPECT_EQ(seconds(std::chrono::seconds(3)), 3);
  EXPECT_EQ(seconds(-std::chrono::milliseconds(250)), -0.25);
  // Parts of a step add up to it: durations are whole ticks, of which no sum is rounded.
  const Clock::duration part = std::chrono::microseconds(100);
  Clock::duration sum{0};
  for (int i = 0; i < 10000; ++i) sum += part;
  EXPECT_EQ(seconds(sum), 1);
}

// Set back by nobody, or a part of a step would take less than nothing.
TEST(Clock, NeverGoesBack) {
  EXPECT_TRUE(Clock::is_steady);
  const Clock::time_point before = Clock::now();
  EXPECT_GE(seconds(Clock::now() - before), 0);
}

}  // namespace
}  // namespace weft
