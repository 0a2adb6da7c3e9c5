// Eq. 7: the level a distance deserves.
#include "cloth/levels/level_policy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft {
namespace {

constexpr double kJustOver = 1.0 + 1e-12;
constexpr double kJustUnder = 1.0 - 1e-12;

TEST(LevelPolicy, TheDefaultIsEquation7WithTable1) {
  // l_close = 1 m, l_far = 10 m; high = 64 x 64 cells = level 6, middle 32 = 5, low 16 = 4.
  const LevelPolicy policy;
  EXPECT_EQ(policy.level_at(0.0), 6);
  EXPECT_EQ(policy.level_at(0.5), 6);
  EXPECT_EQ(policy.level_at(1.0), 6);  // l <= l_close
  EXPECT_EQ(policy.level_at(1.0000001), 5);
  EXPECT_EQ(policy.level_at(5.0), 5);
  EXPECT_EQ(policy.level_at(10.0), 5);  // l <= l_far, where Fig. 6c of the paper contradicts its Eq. 7
  EXPECT_EQ(policy.level_at(std::nextafter(10.0, 11.0)), 4);
  EXPECT_EQ(policy.level_at(1e6), 4);
}

TEST(LevelPolicy, TakesAnyAscendingListOfThresholds) {
  const LevelPolicy policy{{0.5, 1, 2, 4, 8}, {8, 7, 6, 5, 4, 3}, 0.0};
  EXPECT_EQ(policy.level_at(0.0), 8);
  double threshold = 0.5;
  for (int level = 8; level > 3; --level, threshold *= 2) {
    EXPECT_EQ(policy.level_at(threshold), level) << threshold;
    EXPECT_EQ(policy.level_at(threshold * kJustOver), level - 1) << threshold;
  }
  EXPECT_EQ(policy.level_at(1e9), 3);
}

TEST(LevelPolicy, TakesNoThresholdAtAll) {
  const LevelPolicy fixed{{}, {5}, 0.1};
  EXPECT_EQ(fixed.level_at(0.0), 5);
  EXPECT_EQ(fixed.level_at(1e9), 5);
  EXPECT_EQ(fixed.level_at(1e9, 5), 5);
}

TEST(LevelPolicy, LevelsNeedNotBeNeighbours) {
  const LevelPolicy policy{{3.0}, {7, 4}, 0.1};
  EXPECT_EQ(policy.level_at(3.0), 7);
  EXPECT_EQ(policy.level_at(3.01), 4);
  EXPECT_EQ(policy.level_at(3.2, 7), 7);  // 3.3 holds it
  EXPECT_EQ(policy.level_at(3.4, 7), 4);
  EXPECT_EQ(policy.level_at(2.8, 4), 4);  // 2.7 holds it
  EXPECT_EQ(policy.level_at(2.6, 4), 7);
}

TEST(LevelPolicy, HysteresisHoldsTheLevelBothWays) {
  const LevelPolicy policy{{1.0, 10.0}, {6, 5, 4}, 0.1};
  // Outwards a threshold times 1.1 must be passed,
  EXPECT_EQ(policy.level_at(1.1 * kJustUnder, 6), 6);
  EXPECT_EQ(policy.level_at(1.1 * kJustOver, 6), 5);
  EXPECT_EQ(policy.level_at(11.0 * kJustUnder, 5), 5);
  EXPECT_EQ(policy.level_at(11.0 * kJustOver, 5), 4);
  // inwards the threshold times 0.9.
  EXPECT_EQ(policy.level_at(0.9 * kJustOver, 5), 5);
  EXPECT_EQ(policy.level_at(0.9 * kJustUnder, 5), 6);
  EXPECT_EQ(policy.level_at(9.0 * kJustOver, 4), 4);
  EXPECT_EQ(policy.level_at(9.0 * kJustUnder, 4), 5);
}

TEST(LevelPolicy, AJumpOverSeveralBandsLandsInTheRightOne) {
  const LevelPolicy policy{{1.0, 10.0}, {6, 5, 4}, 0.1};
  EXPECT_EQ(policy.level_at(100.0, 6), 4);
  EXPECT_EQ(policy.level_at(0.1, 4), 6);
}

TEST(LevelPolicy, WithoutHysteresisThePresentLevelDoesNotMatter) {
  const LevelPolicy policy;
  for (double distance : {0.0, 0.999, 1.0, 1.001, 5.0, 9.999, 10.0, 10.001, 50.0}) {
    for (int current : {4, 5, 6}) EXPECT_EQ(policy.level_at(distance, current), policy.level_at(distance));
  }
}

TEST(LevelPolicy, ASwayingCameraDoesNotFlap) {
  // 1 m +- 8 cm, ten times: Eq. 7 to the letter changes the level 20 times, a tenth of hysteresis never.
  const auto changes = [](const LevelPolicy& policy) {
    int level = 6, count = 0;
    for (int i = 0; i < 10 * 36; ++i) {
      const double distance = 1.0 + 0.08 * std::sin(i * std::numbers::pi / 18 + 0.01);
      const int next = policy.level_at(distance, level);
      count += next != level ? 1 : 0;
      level = next;
    }
    return count;
  };
  EXPECT_EQ(changes({{1.0, 10.0}, {6, 5, 4}, 0.0}), 20);
  EXPECT_EQ(changes({{1.0, 10.0}, {6, 5, 4}, 0.1}), 0);
}

}  // namespace
}  // namespace weft
