/// What each command does to a scene, what is answered, and who is told.
#include "fixtures.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

using namespace protocol;  // NOLINT(google-build-using-namespace): the commands' names

class Commands : public ::testing::Test {
 protected:
  explicit Commands(const scene::Scene& scene = hung_cloth()) : live(scene, Limits{}) {
    visit = reader.viewer->enter();
    live.add_viewer(reader.viewer, visit);
    other_visit = other.viewer->enter();
    live.add_viewer(other.viewer, other_visit);
    live.publish(0);
    drain();
  }

  /// Gives a command and returns its reply.
  json command(SceneCommand command) {
    live.apply(reader.viewer, visit, {++id, std::move(command)});
    live.publish(0);
    drain();
    return reader.reply(id);
  }
  void steps(int count) {
    for (int i = 0; i < count && live.wants_step(); ++i) {
      live.step();
      live.publish(0);
      drain();
    }
  }
  void drain() {
    reader.drain();
    other.drain();
  }

  LiveScene live;
  Reader reader, other;
  std::uint64_t visit = 0, other_visit = 0;
  std::int64_t id = 0;
};

TEST_F(Commands, TakeEffectInTheNextStep) {
  steps(7);
  const json ok = command(WindSet{{1, 0, 0}, 3.0});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("f"), 8);  // seven steps are made
  EXPECT_EQ(other.last("event", "wind").at("f"), 8);
  EXPECT_EQ(other.last("event", "wind").at("wind"), json({{"direction", {1, 0, 0}}, {"speed", 3.0}}));
  EXPECT_EQ(live.simulation().wind().speed, 3.0);
}

TEST_F(Commands, GustsAreSetWithTheWindAndStayUntilTheyAreSetAgain) {
  command(WindSet{{1, 0, 0}, 3.0, 0.25});
  EXPECT_EQ(other.last("event", "wind").at("wind"),
            json({{"direction", {1, 0, 0}}, {"speed", 3.0}, {"gusts", 0.25}}));
  command(WindSet{{0, 0, -1}, 5.0});
  EXPECT_EQ(live.simulation().wind().gusts.intensity, 0.25);
  command(WindSet{{0, 0, -1}, 5.0, 0.0});
  EXPECT_EQ(live.simulation().wind().gusts.intensity, 0.0);
  EXPECT_FALSE(other.last("event", "wind").at("wind").contains("gusts"));
}

TEST_F(Commands, AWindThatIsSetKeepsTheScenesTurbulenceAndZones) {
  scene::Scene scene = hung_cloth();
  scene.simulation.wind.turbulence = {0.3, 0.7};
  scene.simulation.wind.zones = {WindZone{}};
  LiveScene windy(scene, Limits{});
  const std::uint64_t entered = reader.viewer->enter();
  windy.add_viewer(reader.viewer, entered);
  windy.apply(reader.viewer, entered, {1, WindSet{{1, 0, 0}, 3.0}});
  EXPECT_EQ(windy.simulation().wind().speed, 3.0);
  EXPECT_EQ(windy.simulation().wind().turbulence.intensity, 0.3);
  EXPECT_EQ(windy.simulation().wind().zones.size(), 1U);
}

TEST_F(Commands, WithoutAnIdOnlyErrorsAreAnswered) {
  const auto before = reader.texts.size();
  live.apply(reader.viewer, visit, {std::nullopt, Camera{2.0, std::nullopt}});
  drain();
  EXPECT_EQ(reader.texts.size(), before);
  live.apply(reader.viewer, visit, {std::nullopt, BallMove{99, {0, 0, 0}}});
  drain();
  ASSERT_EQ(reader.texts.size(), before + 1);
  EXPECT_EQ(reader.texts.back().at("code"), "not_found");
  EXPECT_FALSE(reader.texts.back().contains("re"));
}

TEST_F(Commands, BallsAreAddedMovedThrownAndRemoved) {
  const json added = command(BallAdd{{0, 0, 3}, 0.25, {}, false, 1});
  const int ball = added.at("ball");
  EXPECT_EQ(other.last("event", "ball.add").at("ball"), ball);
  EXPECT_EQ(other.last("event", "ball.add").at("balls").at(0).at("radius"), 0.25);
  EXPECT_EQ(command(BallMove{static_cast<std::uint32_t>(ball), {1, 0, 3}}).at("op"), "ok");
  steps(1);
  EXPECT_EQ(reader.frames.back().balls.at(0).position, (std::array<float, 3>{1, 0, 3}));
  EXPECT_FALSE(reader.frames.back().balls[0].dynamic);
  EXPECT_EQ(command(BallThrow{static_cast<std::uint32_t>(ball), {0, 4, 0}}).at("op"), "ok");
  EXPECT_EQ(other.last("event", "ball.throw").at("balls").at(0).at("motion"), "dynamic");
  steps(1);
  EXPECT_TRUE(reader.frames.back().balls.at(0).dynamic);
  EXPECT_GT(reader.frames.back().balls[0].position[1], 0.0F);
  EXPECT_EQ(command(BallRemove{static_cast<std::uint32_t>(ball)}).at("op"), "ok");
  EXPECT_EQ(other.last("event", "ball.remove").at("balls"), json::array());
  steps(1);
  EXPECT_TRUE(reader.frames.back().balls.empty());
}

scene::Scene with_a_box() {
  scene::Scene scene = hung_cloth();
  ObstacleDescription box;
  box.shape = BoxDescription{.size = {0.1, 0.1, 0.1}};
  box.position = {0, 5, 0};
  scene.simulation.obstacles = {box, box};
  return scene;
}

class ObstacleCommands : public Commands {
 protected:
  ObstacleCommands() : Commands(with_a_box()) {}
};

TEST_F(ObstacleCommands, MoveThemAndFramesTellOfThoseThatMoved) {
  steps(1);
  EXPECT_TRUE(reader.frames.back().obstacles.empty());
  EXPECT_EQ(command(ObstacleMove{1, {0, 6, 0}, Turn{0, 1, 0, 0}}).at("op"), "ok");
  EXPECT_EQ(command(BallAdd{{0, 0, 3}, 0.25, {}, false, 1}).at("op"), "ok");  // both kinds of list
  steps(1);
  const FrameObstacle moved{1, {0, 6, 0}, {0, 1, 0, 0}};
  ASSERT_EQ(reader.frames.back().obstacles.size(), 1u);
  EXPECT_EQ(reader.frames.back().obstacles[0], moved);
  EXPECT_EQ(reader.frames.back().balls.size(), 1u);
  EXPECT_EQ(other.frames.back().obstacles.size(), 1u);
  // Without a quaternion it keeps its turn.
  EXPECT_EQ(command(ObstacleMove{1, {0, 7, 0}, {}}).at("op"), "ok");
  steps(1);
  EXPECT_EQ(reader.frames.back().obstacles.at(0), (FrameObstacle{1, {0, 7, 0}, {0, 1, 0, 0}}));
  EXPECT_EQ(command(Reset{}).at("op"), "ok");
  steps(1);
  EXPECT_TRUE(reader.frames.back().obstacles.empty());
  const json error = command(ObstacleMove{2, {}, {}});
  EXPECT_EQ(error.at("code"), "not_found");
  EXPECT_EQ(error.at("path"), "/obstacle");
  EXPECT_EQ(error.at("message"), "/obstacle is 2; the scene has 2 obstacles, counted from 0");
}

TEST_F(Commands, HandsTakeHoldPullAndLetGo) {
  const json grabbed = command(ClothGrab{0, 0.5, 1.0, {}, 50});
  const std::uint32_t grab = grabbed.at("grab");
  EXPECT_EQ(live.simulation().cloths()[0].grabs().at(0).max_force, 50);
  EXPECT_EQ(command(GrabMove{grab, {0, 0, 2}}).at("op"), "ok");
  EXPECT_EQ(live.simulation().cloths()[0].grabs().at(0).hand, Vec3(0, 0, 2));
  steps(30);
  // Another viewer does not hold it.
  live.apply(other.viewer, other_visit, {7, GrabMove{grab, {0, 0, 0}}});
  drain();
  EXPECT_EQ(other.reply(7).at("code"), "not_found");
  EXPECT_EQ(other.reply(7).at("message"),
            "/grab is " + std::to_string(grab) + "; this viewer holds nothing by that id");
  EXPECT_EQ(command(GrabRelease{grab}).at("op"), "ok");
  EXPECT_EQ(command(GrabRelease{grab}).at("code"), "not_found");
  EXPECT_TRUE(live.simulation().cloths()[0].grabs().empty());
  const json error = command(ClothGrab{1, 0.5, 1.0, {}, 50});
  EXPECT_EQ(error.at("path"), "/cloth");
  EXPECT_EQ(error.at("message"), "/cloth is 1; the scene has 1 cloths, counted from 0");
}

TEST_F(Commands, WhoLeavesLetsGoAndAResetLetsAllGo) {
  command(ClothGrab{0, 0.5, 1.0, {}, 50});
  live.apply(other.viewer, other_visit, {7, ClothGrab{0, 0.2, 1.0, {}, 50}});
  EXPECT_EQ(live.simulation().cloths()[0].grabs().size(), 2u);
  live.remove_viewer(other.viewer.get(), other_visit);
  EXPECT_EQ(live.simulation().cloths()[0].grabs().size(), 1u);
  command(Reset{});
  EXPECT_TRUE(live.simulation().cloths()[0].grabs().empty());
  EXPECT_EQ(command(GrabRelease{1}).at("code"), "not_found");
}

TEST_F(Commands, AllViewersAreToldOfPins) {
  const json corners = {{{"u", {0.0, 0.0}}, {"v", {0.0, 0.0}}}, {{"u", {1.0, 1.0}}, {"v", {0.0, 0.0}}}};
  EXPECT_EQ(reader.last("scene").at("cloths").at(0).at("pins"), corners);
  command(ClothPin{0, 0.5, 1});
  json pins = corners;
  pins.push_back({{"u", {0.5, 0.5}}, {"v", {1.0, 1.0}}});
  EXPECT_EQ(other.last("event", "cloth.pin").at("pins"), pins);
  Reader late;
  live.add_viewer(late.viewer, late.viewer->enter());
  late.drain();
  EXPECT_EQ(late.last("scene").at("cloths").at(0).at("pins"), pins);
  command(ClothUnpin{0, 0.9, 0.1});
  pins.erase(1);
  EXPECT_EQ(other.last("event", "cloth.unpin").at("pins"), pins);
  command(Reset{});
  EXPECT_EQ(other.last("event", "reset").at("pins"), json::array({corners}));
}

TEST_F(Commands, The65thGrabAndThe257thPinAreRefused) {
  for (int i = 0; i < 64; ++i) ASSERT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("op"), "ok");
  EXPECT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("code"), "limit");
  const int pins = static_cast<int>(live.simulation().cloths()[0].description().pins.size());
  for (int i = pins; i < 256; ++i) ASSERT_EQ(command(ClothPin{0, 0.5, 0.5}).at("op"), "ok");
  EXPECT_EQ(command(ClothPin{0, 0.5, 0.5}).at("code"), "limit");
}

TEST_F(Commands, PinsAreSetAndTakenAway) {
  const std::size_t pins = live.simulation().cloths()[0].description().pins.size();
  EXPECT_EQ(command(ClothPin{0, 0.5, 1}).at("op"), "ok");
  EXPECT_EQ(live.simulation().cloths()[0].description().pins.size(), pins + 1);
  for (std::size_t i = 0; i <= pins; ++i) EXPECT_EQ(command(ClothUnpin{0, 0.5, 1}).at("op"), "ok");
  EXPECT_EQ(command(ClothUnpin{0, 0.5, 1}).at("message"), "/cloth is 0; it has no pins");
  EXPECT_EQ(command(ClothPin{3, 0.5, 1}).at("code"), "not_found");
}

TEST_F(Commands, OnABallThatIsNotThereAreNotFound) {
  for (const SceneCommand& each :
       std::vector<SceneCommand>{BallMove{5, {}}, BallThrow{5, {}}, BallRemove{5}}) {
    const json error = command(each);
    EXPECT_EQ(error.at("op"), "error");
    EXPECT_EQ(error.at("code"), "not_found");
    EXPECT_EQ(error.at("path"), "/ball");
    EXPECT_EQ(error.at("message"), "/ball is 5; the scene has no such ball");
  }
}

TEST_F(Commands, The65thBallIsRefused) {
  for (int i = 0; i < 64; ++i) {
    ASSERT_EQ(command(BallAdd{{0, 0, 10.0 + i}, 0.1, {}, false, 1}).at("op"), "ok");
  }
  const json error = command(BallAdd{{0, 0, 5}, 0.1, {}, false, 1});
  EXPECT_EQ(error.at("code"), "limit");  // PROTOCOL.md section 6: 64 a scene
  EXPECT_EQ(live.simulation().colliders().balls().size(), 64U);
}

TEST_F(Commands, ABallThatFliesAwayIsRemovedAndTold) {
  command(BallAdd{{0, -999.99, 0}, 0.2, {0, -200, 0}, true, 1});
  steps(1);  // 3.3 m a step, past 1000 m
  EXPECT_TRUE(live.simulation().colliders().balls().empty());
  EXPECT_EQ(other.last("event", "ball.remove").at("balls"), json::array());
}

TEST_F(Commands, PauseStopsTheSceneForAll) {
  steps(4);
  const json ok = command(Pause{});
  EXPECT_EQ(ok.at("f"), 4);
  EXPECT_FALSE(live.wants_step());
  EXPECT_EQ(other.last("event", "pause").at("paused"), true);
  // One more frame of the same step, whose flag tells.
  EXPECT_EQ(other.frames.back().stamp.frame, 4U);
  EXPECT_EQ(other.frames.back().stamp.flags & kFlagPaused, kFlagPaused);
  EXPECT_EQ(command(Resume{}).at("f"), 5);
  EXPECT_TRUE(live.wants_step());
  steps(1);
  EXPECT_EQ(other.frames.back().stamp.flags & kFlagPaused, 0);
}

TEST_F(Commands, StepMakesTheStepsAskedForAndNoMore) {
  steps(2);
  command(Pause{});
  EXPECT_EQ(command(Step{3}).at("f"), 5);
  steps(100);
  EXPECT_EQ(live.simulation().step_count(), 5U);
  EXPECT_EQ(other.frames.back().stamp.frame, 5U);
  EXPECT_EQ(other.frames.back().stamp.flags & kFlagPaused, kFlagPaused);
}

TEST_F(Commands, StepIsRefusedWhileRunningAndBeyondItsLimit) {
  EXPECT_EQ(command(Step{1}).at("code"), "conflict");
  command(Pause{});
  EXPECT_EQ(command(Step{600}).at("op"), "ok");
  EXPECT_EQ(command(Step{1}).at("code"), "limit");
}

TEST_F(Commands, ResetStartsTheNextEpoch) {
  const auto start = live.simulation().cloths()[0].particles().position.y.values();
  steps(5);
  command(BallAdd{{0, 0, 3}, 0.25, {}, false, 1});
  command(WindSet{{1, 0, 0}, 9});
  const json ok = command(Reset{});
  EXPECT_EQ(ok.at("f"), 0);
  EXPECT_EQ(live.epoch(), 2U);
  EXPECT_EQ(live.simulation().step_count(), 0U);
  EXPECT_EQ(live.simulation().wind().speed, 1.0);
  const json event = other.last("event", "reset");
  EXPECT_EQ(event.at("epoch"), 2);
  EXPECT_EQ(event.at("balls"), json::array());
  EXPECT_EQ(event.at("wind").at("speed"), 1.0);
  EXPECT_EQ(other.frames.back().stamp.epoch, 2U);
  EXPECT_EQ(other.frames.back().stamp.frame, 0U);
  EXPECT_EQ(live.simulation().cloths()[0].particles().position.y.values(), start);
}

TEST_F(Commands, APausedSceneAnswersTheCameraWithAFrame) {
  steps(3);
  command(Camera{12.0, std::nullopt});
  steps(1);
  command(Pause{});
  const auto frames = reader.frames.size(), others = other.frames.size();
  command(Camera{0.5, std::nullopt});
  ASSERT_EQ(reader.frames.size(), frames + 1);
  EXPECT_EQ(reader.frames.back().stamp.frame, 4U);
  EXPECT_EQ(reader.frames.back().cloths[0].level, 6);  // split at once, although no step is made
  EXPECT_EQ(other.frames.size(), others + 1);          // the simulated level changed for all
  command(Camera{20.0, std::nullopt});
  EXPECT_EQ(reader.frames.back().cloths[0].level, 4);
  EXPECT_EQ(reader.frames.back().cloths[0].simulated_level, 6);  // nothing is thrown away while it stands
  EXPECT_EQ(other.frames.size(), others + 1);
}

TEST_F(Commands, AJoinIsAnsweredByTheSceneAndAFrameEvenWhilePaused) {
  steps(3);
  command(Pause{});
  Reader late;
  live.add_viewer(late.viewer, late.viewer->enter());
  live.publish(0);
  late.drain();
  ASSERT_EQ(late.texts.size(), 1U);
  EXPECT_EQ(late.texts[0].at("op"), "scene");
  EXPECT_EQ(late.texts[0].at("paused"), true);
  EXPECT_EQ(late.texts[0].at("f"), 3);
  ASSERT_EQ(late.frames.size(), 1U);
  EXPECT_EQ(late.frames[0].stamp.frame, 3U);
}

TEST_F(Commands, StatsTellEachViewerItsOwn) {
  command(Camera{12.0, std::nullopt});
  steps(2);
  live.send_stats(0.5);
  drain();
  const json mine = reader.last("stats"), theirs = other.last("stats");
  EXPECT_EQ(mine.at("rate"), 0.5);
  EXPECT_EQ(mine.at("viewers"), 2);
  EXPECT_EQ(mine.at("cloths").at(0).at("level"), 4);
  EXPECT_EQ(mine.at("cloths").at(0).at("nodes"), 17 * 17);
  EXPECT_EQ(mine.at("cloths").at(0).at("distance"), 12.0);
  EXPECT_EQ(theirs.at("cloths").at(0).at("level"), 5);
  EXPECT_EQ(theirs.at("cloths").at(0).at("nodes"), 33 * 33);
  EXPECT_EQ(theirs.at("cloths").at(0).at("simulated_level"), 5);
  EXPECT_GE(theirs.at("cloths").at(0).at("substeps"), 1);
}

TEST_F(Commands, ASlowClockIsToldOnceAndInEachFrame) {
  live.set_slow(true);
  live.set_slow(true);
  steps(1);
  EXPECT_EQ(other.last("notice").at("code"), "slow");
  EXPECT_EQ(std::count_if(other.texts.begin(), other.texts.end(),
                          [](const json& text) { return text.at("op") == "notice"; }),
            1);
  EXPECT_EQ(other.frames.back().stamp.flags & kFlagSlow, kFlagSlow);
  live.set_slow(false);
  steps(1);
  EXPECT_EQ(other.last("notice").at("code"), "real_time");
  EXPECT_EQ(other.frames.back().stamp.flags & kFlagSlow, 0);
}

TEST_F(Commands, WithoutViewersNothingIsStepped) {
  live.remove_viewer(reader.viewer.get(), visit);
  EXPECT_TRUE(live.wants_step());  // the other one looks
  live.remove_viewer(other.viewer.get(), 1);
  EXPECT_FALSE(live.wants_step());
}

class CommandsWithoutWind : public Commands {
 protected:
  static scene::Scene still() {
    scene::Scene scene = hung_cloth();
    scene.simulation.effects = {GravityEffect{}};
    return scene;
  }
  CommandsWithoutWind() : Commands(still()) {}
};

TEST_F(CommandsWithoutWind, WindIsUnavailable) {
  EXPECT_EQ(command(WindSet{{1, 0, 0}, 3}).at("code"), "unavailable");
}

}  // namespace
}  // namespace weft::host::test
