/// A study is given up without waiting for the step that it makes.
#include "host/study_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

#include "fixtures.h"

namespace weft::host::test {
namespace {

using Clock = std::chrono::steady_clock;

SimulationDescription at_level(int level) {
  SimulationDescription description = hung_cloth().simulation;
  ClothDescription& cloth = description.cloths[0];
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  return description;
}

TEST(StudyThread, WhatIsOfNoUseIsGivenUpAndTheNextStudiedSlow) {
  std::promise<std::uint64_t> done;
  StudyThread study([&](std::uint64_t number, const StudyOutcome&) { done.set_value(number); });
  SimulationDescription heavy = at_level(8);
  heavy.integrator = XpbdDescription{.substeps = 100000};  // a step takes minutes
  study.begin(1, heavy);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto begin = Clock::now();
  study.begin(2, at_level(3));
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(1));  // a matter of microseconds
  auto number = done.get_future();
  ASSERT_EQ(number.wait_for(std::chrono::seconds(120)), std::future_status::ready);
  EXPECT_EQ(number.get(), 2U);
}

TEST(StudyThread, EndsWithItsOwner) {
  const auto begin = Clock::now();
  {
    StudyThread study([](std::uint64_t, const StudyOutcome&) { FAIL(); });
    study.begin(1, at_level(8));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace weft::host::test
