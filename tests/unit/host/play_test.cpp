/// A recording that is shown as a scene: viewers see what was recorded and are told what was commanded in it,
/// and nothing that they do changes it.
#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "host/live_scene.h"
#include "record/recorder.h"

namespace weft::host::test {
namespace {

constexpr int kPlayed = 30;  // of the recording

scene::Scene scene_of_sheet() {
  return std::get<scene::Scene>(scene::parse(R"({
    "cloths": [{"name": "sheet", "size": [1, 1], "levels": {"min": 3, "max": 3}, "pins": ["top"]}],
    "wind": {"direction": [0, 0, 1], "speed": 2},
    "effects": [{"type": "gravity"}, {"type": "paper_wind"}]})",
                                             "sheet"));
}

/// A scene with one viewer.
struct WatchedPlay {
  explicit WatchedPlay(const std::optional<Playing>& playing = {})
      : live(scene_of_sheet(), protocol::Limits{}, playing), visit(reader.viewer->enter()) {
    live.add_viewer(reader.viewer, visit);
    reader.drain();
  }
  json command(SceneCommand command) {
    live.apply(reader.viewer, visit, {++id, std::move(command)});
    live.tell_events();
    reader.drain();
    return reader.reply(id);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) live.step();
    live.tell_events();
    live.publish(0);
    reader.drain();
  }
  std::uint64_t hash() const { return state_hash(live.simulation()); }
  /// How many events of the kind there were.
  long events(const std::string& kind) const {
    return std::count_if(reader.texts.begin(), reader.texts.end(), [&](const json& text) {
      return text.at("op") == "event" && text.at("kind") == kind;
    });
  }

  LiveScene live;
  Reader reader;
  std::uint64_t visit;
  std::int64_t id = 0;
};

class Play : public ::testing::Test {
 protected:
  /// Records what a viewer does in kPlayed steps, and the state after each.
  Play() {
    WatchedPlay was;
    std::string bytes;
    const auto recorder = std::make_shared<record::Recorder>(scene_of_sheet(), json::object(),
                                                             [&](const std::string& more) { bytes += more; });
    was.live.record({recorder});
    const auto note = [&](int count) {
      for (int i = 0; i < count; ++i) {
        was.steps(1);
        hashes_.push_back(was.hash());
      }
    };
    hashes_.push_back(was.hash());
    note(10);
    was.command(protocol::BallAdd{.position = {0, 0, 0.4}, .radius = 0.1});
    was.command(protocol::WindSet{{1, 0, 0}, 5});
    was.command(protocol::EffectSet{"gravity", false});
    note(10);
    was.command(protocol::ClothPin{0, 0.5, 1});
    was.command(protocol::EffectTune{"paper_wind", {{"factor", {0.25}}}});
    was.command(protocol::BallRemove{1});
    note(kPlayed - 20);
    recorder->flush();
    recording_ = std::make_shared<const record::Recording>(record::Recording::of_text(std::move(bytes)));
  }

  Playing playing(std::uint64_t from = 0, bool loop = false) const { return {recording_, from, loop}; }

  std::vector<std::uint64_t> hashes_;  ///< after so many steps
  std::shared_ptr<const record::Recording> recording_;
};

TEST_F(Play, EachStepIsAsItWasRecorded) {
  WatchedPlay shown(playing());
  for (std::size_t step = 1; step <= kPlayed; ++step) {
    shown.steps(1);
    // Commands that come before the next step are done already, but change nothing until it.
    if (step != 10 && step != 20) {
      ASSERT_EQ(shown.hash(), hashes_[step]) << step;
    }
  }
  EXPECT_EQ(shown.reader.frames.back().stamp.frame, static_cast<std::uint32_t>(kPlayed));
}

TEST_F(Play, ViewersAreToldWhatWasCommanded) {
  WatchedPlay shown(playing());
  shown.steps(9);
  EXPECT_EQ(shown.reader.texts.back().at("op"), "scene") << "nothing was commanded yet";
  shown.steps(1);
  EXPECT_EQ(shown.events("ball.add"), 1);
  EXPECT_EQ(shown.reader.last("event", "wind").at("wind").at("speed"), 5);
  shown.steps(1);
  EXPECT_EQ(shown.reader.last("event", "effect").at("effects_off"), json({"gravity"}));
  EXPECT_EQ(shown.reader.frames.back().balls.size(), 1u);
  shown.steps(10);
  EXPECT_EQ(shown.reader.last("event", "cloth.pin").at("pins").size(), 2u);
  EXPECT_EQ(shown.reader.last("event", "tune").at("parameters").at("factor"), 0.25);
  EXPECT_EQ(shown.events("ball.remove"), 1);
  EXPECT_TRUE(shown.reader.frames.back().balls.empty());
}

TEST(PlayOfResets, EachBeginsAnEpoch) {
  std::string bytes;
  const auto recorder = std::make_shared<record::Recorder>(scene_of_sheet(), json::object(),
                                                           [&](const std::string& more) { bytes += more; });
  {
    WatchedPlay was;
    was.live.record({recorder});
    for (const int steps : {1, 1, 5}) {
      was.steps(steps);
      was.command(protocol::Reset{});
    }
    was.steps(2);
    recorder->flush();
  }
  WatchedPlay shown(
      Playing{std::make_shared<const record::Recording>(record::Recording::of_text(std::move(bytes)))});
  std::vector<std::uint32_t> epochs;
  for (int step = 0; step < 9; ++step) {
    shown.steps(1);
    epochs.push_back(shown.live.epoch());
  }
  // A reset is done after the last step before it.
  EXPECT_EQ(epochs, (std::vector<std::uint32_t>{2, 3, 3, 3, 3, 3, 4, 4, 4}));
  EXPECT_EQ(shown.events("reset"), 3);
}

// The viewer's own: what was recorded does not take back what it has asked for.
TEST(PlayOfResets, StepsThatAViewerAskedForGoOnBehindOne) {
  std::string bytes;
  const auto recorder = std::make_shared<record::Recorder>(scene_of_sheet(), json::object(),
                                                           [&](const std::string& more) { bytes += more; });
  {
    WatchedPlay was;
    was.live.record({recorder});
    was.steps(3);
    was.command(protocol::Reset{});
    was.steps(7);
    recorder->flush();
  }
  WatchedPlay shown(
      Playing{std::make_shared<const record::Recording>(record::Recording::of_text(std::move(bytes)))});
  shown.command(protocol::Pause{});
  EXPECT_EQ(shown.command(protocol::Step{6}).at("op"), "ok");
  int made = 0;
  for (; shown.live.wants_step(); ++made) shown.steps(1);
  EXPECT_EQ(made, 6);
  EXPECT_EQ(shown.live.epoch(), 2u);
  EXPECT_EQ(shown.live.simulation().step_count(), 3u);  // of six the last three are the new epoch's
}

TEST_F(Play, WhoComesLateIsToldTheSame) {
  WatchedPlay shown(playing());
  shown.steps(22);
  Reader late;
  shown.live.add_viewer(late.viewer, late.viewer->enter());
  late.drain();
  const json scene = late.last("scene");
  EXPECT_EQ(scene.at("f"), 22);
  EXPECT_EQ(scene.at("wind").at("speed"), 5);
  EXPECT_EQ(scene.at("effects_off"), json({"gravity"}));
  EXPECT_EQ(scene.at("parameters").at("paper_wind").at("factor"), 0.25);
}

TEST_F(Play, BeginsWhereItIsTold) {
  const WatchedPlay shown(playing(15));
  EXPECT_EQ(shown.hash(), hashes_[15]);
  EXPECT_EQ(shown.live.simulation().step_count(), 15u);
}

TEST_F(Play, WhatWouldChangeItIsRefused) {
  WatchedPlay shown(playing());
  shown.steps(3);
  for (const SceneCommand& command : std::initializer_list<SceneCommand>{
           protocol::BallAdd{.position = {0, 0, 0.4}, .radius = 0.1}, protocol::WindSet{{1, 0, 0}, 5},
           protocol::EffectSet{"gravity", false}, protocol::ClothPin{0, 0.5, 1},
           protocol::ClothGrab{.cloth = 0, .u = 0.5, .v = 0.5}, protocol::Cost{}}) {
    const json reply = shown.command(command);
    EXPECT_EQ(reply.at("op"), "error");
    EXPECT_EQ(reply.at("code"), "unavailable");
    EXPECT_EQ(reply.at("message"),
              "a recording is shown: it can be watched, paused, stepped and begun anew (reset), not changed");
  }
  shown.steps(2);
  EXPECT_EQ(shown.hash(), hashes_[5]);
}

TEST_F(Play, CanBePausedSteppedAndSeenFromAnywhere) {
  WatchedPlay shown(playing());
  EXPECT_EQ(shown.command(protocol::Pause{}).at("op"), "ok");
  EXPECT_FALSE(shown.live.wants_step());
  EXPECT_EQ(shown.command(protocol::Step{4}).at("op"), "ok");
  shown.steps(4);
  EXPECT_FALSE(shown.live.wants_step());
  EXPECT_EQ(shown.hash(), hashes_[4]);
  EXPECT_EQ(shown.command(protocol::Camera{0.3, std::nullopt}).at("op"), "ok");
  EXPECT_EQ(shown.hash(), hashes_[4]);
}

TEST_F(Play, PausesAtItsEndAndBeginsAnewByReset) {
  WatchedPlay shown(playing(5));
  shown.steps(kPlayed - 5);
  EXPECT_TRUE(shown.live.paused());
  EXPECT_EQ(shown.events("pause"), 1);
  shown.command(protocol::Resume{});
  shown.steps(1);  // there is none left
  EXPECT_TRUE(shown.live.paused());
  EXPECT_EQ(shown.hash(), hashes_[kPlayed]);

  shown.command(protocol::Reset{});
  EXPECT_EQ(shown.hash(), hashes_[5]);
  const json reset = shown.reader.last("event", "reset");
  EXPECT_EQ(reset.at("epoch"), 2);
  EXPECT_EQ(reset.at("f"), 5);
  EXPECT_EQ(reset.at("wind").at("speed"), 2);  // as then
}

// To viewers a reset has all effects on, but at step 15 of this recording gravity was off.
TEST_F(Play, TellsWhichEffectsAreOffWhereItBeginsAnew) {
  WatchedPlay shown(playing(15));
  shown.command(protocol::Reset{});
  const auto& texts = shown.reader.texts;
  const auto is = [](const char* kind) {
    return [kind](const json& text) { return text.value("kind", "") == kind; };
  };
  const auto reset = std::find_if(texts.begin(), texts.end(), is("reset"));
  const auto effect = std::find_if(reset, texts.end(), is("effect"));
  ASSERT_NE(effect, texts.end());
  EXPECT_EQ(effect->at("effects_off"), json({"gravity"}));
}

TEST_F(Play, LoopsIfItIsToldTo) {
  WatchedPlay shown(playing(5, true));
  shown.steps(kPlayed - 5);
  EXPECT_FALSE(shown.live.paused());
  EXPECT_EQ(shown.live.epoch(), 2u);
  EXPECT_EQ(shown.hash(), hashes_[5]);
  shown.steps(3);
  EXPECT_EQ(shown.hash(), hashes_[8]);
}

}  // namespace
}  // namespace weft::host::test
