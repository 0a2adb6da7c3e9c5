/// What a viewer's balls and obstacles may cost a scene.
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using namespace protocol;  // NOLINT(google-build-using-namespace): the commands' names

/// 1.8 m x 1.2 m of silk that a pole holds by its left edge, at level 6.
scene::Scene flag() {
  scene::Scene scene = std::get<scene::Scene>(scene::load("flag", {}));
  scene.camera_distance = 0.5;
  return scene;
}

class PutBodies : public Commands {
 protected:
  PutBodies() : Commands(flag()) {}
  double work() const { return live.simulation().cloths()[0].work(); }
};

TEST_F(PutBodies, ABallLargerThanTheClothIsRefused) {
  const json error =
      command(BallAdd{.position = {0, 0.5, 0}, .radius = 10, .motion = Motion::dynamic, .mass = 1e4});
  EXPECT_EQ(error.at("code"), "range");
  EXPECT_EQ(error.at("path"), "/radius");
  // The diagonal is 2.1633 m.
  EXPECT_EQ(error.at("message"), "/radius is 10.0; allowed: 0.01..2.17 (m, in this scene: its cloth's size)");
  EXPECT_EQ(command(BallAdd{.position = {0, 0, 5}, .radius = 2.1}).at("op"), "ok");
}

// Each of them swallows the pole: springs between what it holds and what balls push away would be a hundred
// times their length, and a step take thousands of substeps.
TEST_F(PutBodies, WhatMakesAStepTakeTooMuchWorkIsTakenAwaySlow) {
  steps(3);
  const double usual = work();
  EXPECT_GT(usual, 1e5);
  const json honest = command(BallAdd{.position = {0, 0, 8}, .radius = 0.2});
  for (int k = 0; k < 60; ++k) {
    const double z = k / 1000.0;
    const json ok =
        command(BallAdd{.position = {0, 0.5, z}, .radius = 2, .motion = Motion::dynamic, .mass = 1e4});
    ASSERT_EQ(ok.at("op"), "ok");
  }
  int stood_still = 0;
  for (int step = 0; step < 60; ++step) {
    steps(1);
    EXPECT_LT(work(), 2e7) << step;  // the limit and one piece of work more
    stood_still += work() > 1.2e7;
  }
  // They push each other apart at once; those that are at the cloth when it stands still are taken away.
  EXPECT_GE(stood_still, 1);
  EXPECT_LE(stood_still, 3);
  const auto& balls = live.simulation().colliders().balls();
  EXPECT_LT(balls.size(), 61U);
  EXPECT_NE(live.simulation().colliders().find(honest.at("ball")), nullptr);
  EXPECT_EQ(other.last("event", "ball.remove").at("balls").size(), balls.size());
  EXPECT_FALSE(other.last("notice", "too_costly").is_null());
  EXPECT_FALSE(live.simulation().cloths()[0].frozen());
  EXPECT_LT(work(), 4 * usual);
  // Who did it puts nothing more for 10 s.
  const json refused = command(BallAdd{.position = {0, 0, 8}, .radius = 0.2});
  EXPECT_EQ(refused.at("code"), "limit");
  live.apply(other.viewer, other_visit, {7, BallAdd{.position = {0, 0, 8}, .radius = 0.2}});
  drain();
  EXPECT_EQ(other.reply(7).at("op"), "ok");
}

TEST_F(PutBodies, ABallDraggedThroughTheFlagStays) {
  const json ball = command(BallAdd{.position = {0.9, 0, 1}, .radius = 0.15});
  for (int i = 0; i < 12; ++i) {
    command(BallMove{ball.at("ball").get<std::uint32_t>(), {0.9, 0, 1 - i / 6.0}});
    steps(1);
  }
  EXPECT_EQ(live.simulation().colliders().balls().size(), 1U);
}

}  // namespace
}  // namespace weft::host::test
