/// What each command does to a scene, what is answered, and who is told.
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using namespace protocol;  // NOLINT(google-build-using-namespace): the commands' names

TEST_F(Commands, TakeEffectInTheNextStep) {
  steps(7);
  const json ok = command(WindSet{{1, 0, 0}, 3.0});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("f"), 8);  // seven steps are made
  EXPECT_EQ(other.last("event", "wind").at("f"), 8);
  EXPECT_EQ(other.last("event", "wind").at("wind"), json({{"direction", {1, 0, 0}}, {"speed", 3.0}}));
  EXPECT_EQ(live.simulation().wind().speed, 3.0);
}

// However many commands come between two frames, each viewer is told once.
TEST_F(Commands, EventsOfOneThingAreToldOnceAFrame) {
  other.texts.clear();
  for (int i = 1; i <= 400; ++i)
    live.apply(reader.viewer, visit, {std::nullopt, WindSet{{1, 0, 0}, 0.1 * i}});
  live.apply(reader.viewer, visit, {std::nullopt, BallAdd{.position = {0, 0, 3}, .radius = 0.1}});
  steps(1);
  ASSERT_EQ(other.texts.size(), 2U);
  EXPECT_NEAR(other.texts[0].at("wind").at("speed").get<double>(), 40, 1e-9);
  EXPECT_EQ(other.texts[1].at("kind"), "ball.add");
}

TEST_F(Commands, GustsAreSetWithTheWindAndStayUntilTheyAreSetAgain) {
  command(WindSet{{1, 0, 0}, 3.0, 0.25});
  EXPECT_EQ(other.last("event", "wind").at("wind"),
            json({{"direction", {1, 0, 0}}, {"speed", 3.0}, {"gusts", 0.25}, {"time_scale", 3.0}}));
  command(WindSet{{0, 0, -1}, 5.0});
  EXPECT_EQ(live.simulation().wind().gusts.intensity, 0.25);
  command(WindSet{{0, 0, -1}, 5.0, 0.0});
  EXPECT_EQ(live.simulation().wind().gusts.intensity, 0.0);
  EXPECT_FALSE(other.last("event", "wind").at("wind").contains("gusts"));
}

TEST_F(Commands, SoAreEddies) {
  command(WindSet{{1, 0, 0}, 3.0, {}, 0.5});
  EXPECT_EQ(other.last("event", "wind").at("wind"),
            json({{"direction", {1, 0, 0}}, {"speed", 3.0}, {"turbulence", 0.5}, {"length_scale", 0.5}}));
  command(WindSet{{0, 0, -1}, 5.0});
  EXPECT_EQ(live.simulation().wind().turbulence.intensity, 0.5);
  command(WindSet{{0, 0, -1}, 5.0, {}, 0.0});
  EXPECT_FALSE(other.last("event", "wind").at("wind").contains("turbulence"));
}

// How long gusts last and how large eddies are, too, whether there are any yet or not.
TEST_F(Commands, SoAreTheScalesOfBoth) {
  command(WindSet{.direction = {1, 0, 0}, .speed = 3.0, .time_scale = 1.5, .length_scale = 0.25});
  EXPECT_EQ(other.last("event", "wind").at("wind"), json({{"direction", {1, 0, 0}}, {"speed", 3.0}}));
  command(WindSet{{1, 0, 0}, 3.0, 0.25, 0.5});
  EXPECT_EQ(other.last("event", "wind").at("wind"), json({{"direction", {1, 0, 0}},
                                                          {"speed", 3.0},
                                                          {"gusts", 0.25},
                                                          {"time_scale", 1.5},
                                                          {"turbulence", 0.5},
                                                          {"length_scale", 0.25}}));
}

scene::Scene with_zones() {
  scene::Scene scene = hung_cloth();
  WindZone box, sphere;
  box.shape = BoxZone{.size = {1, 2, 3}};
  box.position = {0, 1, 0};
  sphere.shape = SphereZone{.radius = 2};
  sphere.velocity = {0, 0, 3};
  scene.simulation.wind.zones = {box, sphere};
  return scene;
}

class ZoneCommands : public Commands {
 protected:
  ZoneCommands() : Commands(with_zones()) {}
};

TEST_F(ZoneCommands, SetTheAirOfOneAndTellAll) {
  const json zones = reader.last("scene").at("wind").at("zones");
  EXPECT_EQ(zones.at(0), json({{"shape", "box"},
                               {"position", {0.0, 1.0, 0.0}},
                               {"size", {1.0, 2.0, 3.0}},
                               {"quaternion", {1.0, 0.0, 0.0, 0.0}},
                               {"velocity", {0.0, 0.0, 0.0}},
                               {"edge", 0.1}}));
  EXPECT_EQ(zones.at(1), json({{"shape", "sphere"},
                               {"position", {0.0, 0.0, 0.0}},
                               {"radius", 2.0},
                               {"velocity", {0.0, 0.0, 3.0}},
                               {"edge", 0.1}}));
  EXPECT_EQ(command(WindZoneSet{1, {0, 5, 0}}).at("op"), "ok");
  EXPECT_EQ(other.last("event", "wind").at("wind").at("zones").at(0), zones.at(0));
  EXPECT_EQ(other.last("event", "wind").at("wind").at("zones").at(1).at("velocity"), json({0.0, 5.0, 0.0}));
  EXPECT_EQ(live.simulation().wind().zones[1].velocity, Vec3(0, 5, 0));
  EXPECT_EQ(live.simulation().wind().zones[0].velocity, Vec3(0, 0, 0));
  const json error = command(WindZoneSet{2, {0, 5, 0}});
  EXPECT_EQ(error.at("code"), "not_found");
  EXPECT_EQ(error.at("message"), "/zone is 2; the wind has no such zone");
  command(Reset{});
  EXPECT_EQ(other.last("event", "reset").at("wind").at("zones"), zones);
}

TEST_F(ZoneCommands, AZoneBlowsWhatIsInIt) {
  // All of the cloth lies in the sphere; set to blow as the wind did it hangs as it does without a zone.
  LiveScene plain(hung_cloth(), Limits{});
  Reader alone;
  plain.add_viewer(alone.viewer, alone.viewer->enter());
  for (int i = 0; i < 20; ++i) plain.step();
  steps(20);
  EXPECT_GT(live.simulation().centre(0).z(), plain.simulation().centre(0).z() + 0.01);  // the other way
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
  const json added = command(BallAdd{{0, 0, 3}, 0.25, {}, Motion::kinematic, 1});
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
    ASSERT_EQ(command(BallAdd{{0, 0, 10.0 + i}, 0.1, {}, Motion::kinematic, 1}).at("op"), "ok");
  }
  const json error = command(BallAdd{{0, 0, 5}, 0.1, {}, Motion::kinematic, 1});
  EXPECT_EQ(error.at("code"), "limit");  // PROTOCOL.md section 6: 64 a scene
  EXPECT_EQ(live.simulation().colliders().balls().size(), 64U);
}

TEST_F(Commands, ABallThatFliesAwayIsRemovedAndTold) {
  command(BallAdd{{0, -999.99, 0}, 0.2, {0, -200, 0}, Motion::dynamic, 1});
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
  command(BallAdd{{0, 0, 3}, 0.25, {}, Motion::kinematic, 1});
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
  live.apply(other.viewer, 1, {std::nullopt, Camera{5.0, std::nullopt}});
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
  live.send_stats(0.5);
  drain();
  EXPECT_EQ(other.last("stats").at("limit"), "server");
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
