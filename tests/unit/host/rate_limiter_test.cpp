#include "host/rate_limiter.h"

#include <gtest/gtest.h>

namespace weft::host {
namespace {

using std::chrono::milliseconds;

TEST(RateLimiter, AllowsASecondsWorthAtOnceAndThenTheRate) {
  const RateLimiter::TimePoint start{std::chrono::hours(1)};
  RateLimiter limiter(120, start);
  int allowed = 0;
  for (int i = 0; i < 500; ++i) allowed += limiter.allow(start);
  EXPECT_EQ(allowed, 120);
  for (int i = 1; i <= 500; ++i) allowed += limiter.allow(start + milliseconds(2 * i));  // 500 a second
  // 120 more; the last may miss the second's end by a rounding.
  EXPECT_NEAR(allowed, 240, 1);
}

TEST(RateLimiter, SavesNoMoreThanOneSecond) {
  const RateLimiter::TimePoint start{std::chrono::hours(1)};
  RateLimiter limiter(10, start);
  int allowed = 0;
  for (int i = 0; i < 100; ++i) allowed += limiter.allow(start + std::chrono::hours(1));
  EXPECT_EQ(allowed, 10);
}

}  // namespace
}  // namespace weft::host
