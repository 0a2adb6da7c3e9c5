#include "host/step_clock.h"

#include <gtest/gtest.h>

namespace weft::host {
namespace {

using std::chrono::milliseconds;
using TimePoint = StepClock::TimePoint;

constexpr double kStep = 0.010;  // s
const TimePoint kStart{std::chrono::hours(1)};

/// Makes steps that each take `cost`, as a scene's thread does; returns when the last one ended.
TimePoint make_steps(StepClock& clock, TimePoint now, int steps, milliseconds cost) {
  for (int i = 0; i < steps; ++i) {
    now = std::max(now, clock.next()) + cost;
    clock.stepped(now);
  }
  return now;
}

TEST(StepClock, StepsAreDueEveryTimeStep) {
  StepClock clock(kStep);
  clock.start(kStart);
  EXPECT_EQ(clock.next(), kStart);
  make_steps(clock, kStart, 7, milliseconds(3));
  EXPECT_EQ(clock.next(), kStart + milliseconds(70));
}

TEST(StepClock, QuickStepsAreRealTime) {
  StepClock clock(kStep);
  clock.start(kStart);
  make_steps(clock, kStart, 300, milliseconds(9));
  EXPECT_EQ(clock.rate(), 1.0);
  EXPECT_FALSE(clock.slow());
}

TEST(StepClock, LongStepsSlowTheClock) {
  StepClock clock(kStep);
  clock.start(kStart);
  make_steps(clock, kStart, 100, milliseconds(40));  // 4 s of real time, 1 s of simulated time
  EXPECT_NEAR(clock.rate(), 0.25, 0.01);             // 10 ms / 40 ms; 1 % for where the window ends
  EXPECT_TRUE(clock.slow());
}

TEST(StepClock, OneLateStepIsCaughtUp) {
  StepClock clock(kStep);
  clock.start(kStart);
  const TimePoint late = make_steps(clock, kStart, 1, milliseconds(25));  // 15 ms behind, within two steps
  EXPECT_EQ(clock.next(), kStart + milliseconds(10));
  make_steps(clock, late, 10, milliseconds(1));
  EXPECT_EQ(clock.next(), kStart + milliseconds(110));  // as if nothing had been
}

TEST(StepClock, LostTimeIsNotCaughtUpInABurst) {
  StepClock clock(kStep);
  clock.start(kStart);
  const TimePoint late = make_steps(clock, kStart, 1, milliseconds(500));
  EXPECT_EQ(clock.next(), late);
  clock.stepped(late + milliseconds(1));
  EXPECT_EQ(clock.next(), late + milliseconds(10));
}

TEST(StepClock, RecoversAfterASecondWithoutLoss) {
  StepClock clock(kStep);
  clock.start(kStart);
  TimePoint now = make_steps(clock, kStart, 40, milliseconds(30));  // 1.2 s
  ASSERT_TRUE(clock.slow());
  now = make_steps(clock, now, 250, milliseconds(1));  // at least one whole window without loss
  EXPECT_FALSE(clock.slow());
  EXPECT_EQ(clock.rate(), 1.0);
}

TEST(StepClock, StandingStillIsNotLost) {
  StepClock clock(kStep);
  clock.start(kStart);
  TimePoint now = make_steps(clock, kStart, 10, milliseconds(1)) + std::chrono::seconds(30);
  clock.start(now);
  EXPECT_EQ(clock.next(), now);
  make_steps(clock, now, 200, milliseconds(1));
  EXPECT_EQ(clock.rate(), 1.0);
  EXPECT_FALSE(clock.slow());
}

}  // namespace
}  // namespace weft::host
