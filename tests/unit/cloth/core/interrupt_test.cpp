// Ways to end a step in hand: asked from outside, and by the work that it takes.
#include "cloth/core/interrupt.h"

#include <gtest/gtest.h>

#include <thread>

namespace weft::test {
namespace {

TEST(Interrupt, WithoutAskingNothingEnds) {
  EXPECT_EQ(Interruptible::current(), nullptr);
  EXPECT_NO_THROW(check_interrupt(1e300));
}

TEST(Interrupt, AStopEndsWhatIsUnderWayOnItsThreadAlone) {
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const Interruptible interruptible(&token);
  EXPECT_NO_THROW(check_interrupt(1));
  source.request_stop();
  EXPECT_THROW(check_interrupt(0), Interrupted);
  bool ended = false;
  std::thread([&] {
    try {
      check_interrupt(1);
    } catch (const Interrupted&) {
      ended = true;
    }
  }).join();
  EXPECT_FALSE(ended);
}

TEST(Interrupt, TheInnermostCounts) {
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const Interruptible outer(&token);
  source.request_stop();
  {
    const Interruptible inner(nullptr);
    EXPECT_NO_THROW(check_interrupt(1));
  }
  EXPECT_EQ(Interruptible::current(), &token);
  EXPECT_THROW(check_interrupt(1), Interrupted);
}

TEST(WorkLimit, WorkIsAddedUpToTheMost) {
  const WorkLimit limit(10);
  EXPECT_NO_THROW(check_interrupt(4));
  EXPECT_NO_THROW(check_interrupt(6));
  EXPECT_EQ(limit.done(), 10);
  EXPECT_THROW(check_interrupt(0.5), TooMuchWork);
}

TEST(WorkLimit, WhatAnInnerOneCountsTheOuterOneDoesNot) {
  const WorkLimit outer(10);
  check_interrupt(3);
  {
    const WorkLimit inner(WorkLimit::kNone);
    EXPECT_NO_THROW(check_interrupt(1000));
    EXPECT_EQ(inner.done(), 1000);
  }
  EXPECT_EQ(outer.done(), 3);
}

}  // namespace
}  // namespace weft::test
