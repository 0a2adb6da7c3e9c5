// What a viewer is sent follows what its link carries: fewer frames, then a coarser level, and back.
#include "host/link_keeper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace weft::host {
namespace {

constexpr int kMade = 30;  // frames a stretch: 60 a second
using Limit = LinkKeeper::Limit;

/// A link that carries `carried` frames of the finest level a stretch; those of the next coarser one are a
/// quarter as long.
Viewer::Flow over(double carried, int coarser) {
  const int most = static_cast<int>(carried * std::pow(4, coarser));
  return {kMade, kMade - std::min(kMade, most), false};
}

class Link : public ::testing::Test {
 protected:
  /// Runs so many stretches; the number of changes of level.
  int run(double carried, int stretches, int most = 2) {
    int changes = 0;
    for (int i = 0; i < stretches; ++i) {
      const int before = keeper.coarser();
      keeper.passed(over(carried, before), most);
      changes += keeper.coarser() != before;
    }
    return changes;
  }
  LinkKeeper keeper;
};

}  // namespace

TEST_F(Link, WithRoomForAllNothingChanges) {
  EXPECT_EQ(run(1000, 100), 0);
  EXPECT_EQ(keeper.limit(), Limit::nothing);
}

// Half of the frames, then a third: seen as they are, at the level of the distance.
TEST_F(Link, FewerFramesComeFirst) {
  for (const double carried : {15.0, 10.0, 8.0}) {
    EXPECT_EQ(run(carried, 100), 0) << carried;
    EXPECT_EQ(keeper.limit(), Limit::link);
  }
}

// 7 of 30 are less than a quarter. A level coarser 28 go through, less than a tenth left out.
TEST_F(Link, ThenTheLevelBecomesCoarser) {
  EXPECT_EQ(run(7, LinkKeeper::kSettling - 1), 0);
  EXPECT_EQ(run(7, 1), 1);
  EXPECT_EQ(keeper.coarser(), 1);
  run(7, 1);
  EXPECT_EQ(keeper.limit(), Limit::nothing);
}

// One frame in two stretches: of levels 1 and 2 coarser 2 and 8.
TEST_F(Link, NoMoreLevelsThanThereAre) {
  run(0.5, 100, 1);
  EXPECT_EQ(keeper.coarser(), 1);
  run(0.5, 100, 2);
  EXPECT_EQ(keeper.coarser(), 2);
  run(0.5, 1, 1);  // the viewer goes farther away
  EXPECT_EQ(keeper.coarser(), 1);
}

TEST_F(Link, FinerAgainWhenTheLinkRecovers) {
  run(1, 10);
  ASSERT_EQ(keeper.coarser(), 2);
  EXPECT_EQ(run(1000, LinkKeeper::kPatience - 1), 0);
  EXPECT_EQ(run(1000, 2 * LinkKeeper::kPatience + 1), 2);
  EXPECT_EQ(keeper.coarser(), 0);
}

// Tries last kSettling stretches, and the n-th comes 6 * 2^n stretches after the one before: in 1,000 fewer
// than log2(1000 / 6) of them, each two changes.
TEST_F(Link, TwoLevelsAreNotSwappedForEver) {
  EXPECT_LE(run(7.2, 1000), 1 + 2 * 8);
  EXPECT_GE(run(7.2, 1000), 2);  // still tried from time to time
}

TEST_F(Link, ASlowViewerIsNotTheLinksFault) {
  for (int i = 0; i < 20; ++i) keeper.passed({kMade, kMade - 2, true}, 2);
  EXPECT_EQ(keeper.limit(), Limit::client);
  EXPECT_EQ(keeper.coarser(), 0);
}

TEST_F(Link, AFewFramesSayNothing) {
  run(10, 1);
  EXPECT_EQ(keeper.limit(), Limit::link);
  for (int i = 0; i < 20; ++i) keeper.passed({LinkKeeper::kLeastFrames - 1, 7, false}, 2);
  EXPECT_EQ(keeper.limit(), Limit::nothing);
  EXPECT_EQ(keeper.coarser(), 0);
}

// No frame or a few, and all of them arrive: of what rests the viewer gets the finer levels back.
TEST_F(Link, WhileHardlyAnyFramesAreMadeItHasRoom) {
  for (const int made : {0, 1, LinkKeeper::kLeastFrames - 1}) {
    keeper = {};
    run(1, 10);
    ASSERT_EQ(keeper.coarser(), 2);
    for (int i = 0; i < 2 * LinkKeeper::kPatience; ++i) keeper.passed({made, 0, false}, 2);
    EXPECT_EQ(keeper.coarser(), 0) << made;
    EXPECT_EQ(keeper.limit(), Limit::nothing);
  }
}

}  // namespace weft::host
