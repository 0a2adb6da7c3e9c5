// Quality in a live scene: what viewers are told and what is stepped, with the outcome of a study given.
#include "choices.h"
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

scene::Scene kept_to(const scene::Quality& quality) {
  scene::Scene scene = hung_cloth();
  scene.quality = quality;
  return scene;
}

class LiveQuality : public LiveSceneTest {
 protected:
  explicit LiveQuality(const scene::Quality& own = {}) : LiveSceneTest(kept_to(own)) {}

  /// `quality` of the stats, or null.
  json quality() {
    live.send_stats(1);
    drain();
    return other.last("stats").value("quality", json());
  }
  void study() {
    live.take_study({three_levels(), ""});
    drain();
  }
  int substeps() {
    live.step();
    return live.simulation().report(0).substeps;
  }
};

class QualityOfAScene : public LiveQuality {
 protected:
  QualityOfAScene() : LiveQuality({0.05, std::nullopt}) {}
};

TEST_F(LiveQuality, NobodyAskedForCostsNothing) {
  live.step();
  EXPECT_FALSE(live.wants_study());
  EXPECT_EQ(quality(), nullptr);
}

TEST_F(LiveQuality, IsMeasuredAndThenChosen) {
  const json ok = command(protocol::Quality{0.05, std::nullopt});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("quality"), json({{"wish", {{"max_error", 0.05}}}, {"state", "measuring"}}));
  EXPECT_EQ(other.last("event", "quality").at("wish"), json({{"max_error", 0.05}}));
  EXPECT_TRUE(live.wants_study());
  EXPECT_EQ(quality(), json({{"wish", {{"max_error", 0.05}}}, {"state", "measuring"}}));
  study();
  EXPECT_FALSE(live.wants_study());
  EXPECT_EQ(substeps(), 10);
  const json chosen = quality();
  EXPECT_GT(chosen.at("ms_measured"), 0.0);
  const json expected = {{"state", "chosen"}, {"integrator", "xpbd"}, {"setting", "10 substeps"},
                         {"level", 5},        {"ms_expected", 8.0},   {"error_expected", 0.01},
                         {"span", 10.0},      {"space", 0.005},       {"met", true}};
  for (const auto& [name, value] : expected.items()) {
    EXPECT_EQ(chosen.at(name), value) << name;
  }
}

TEST_F(LiveQuality, TheReplyTellsOverWhichSpanTheErrorWasMeasured) {
  command(protocol::Cost{});
  study();
  EXPECT_EQ(command(protocol::Quality{0.05, std::nullopt}).at("quality").at("span"), 10.0);
  EXPECT_EQ(command(protocol::Quality{0.001, std::nullopt}).at("quality").at("span"), 2.0);
}

TEST_F(LiveQuality, FollowsTheLevelThatViewersWant) {
  command(protocol::Quality{std::nullopt, 9.0});
  study();
  EXPECT_EQ(substeps(), 10);
  command(protocol::Camera{0.5, std::nullopt});  // level 6: only a coarser one is within 9 ms
  EXPECT_EQ(quality().at("level"), 5);
  live.step();
  EXPECT_EQ(live.simulation().cloths()[0].level(), 5);
  command(protocol::Quality{std::nullopt, 100.0});
  EXPECT_EQ(substeps(), 20);
  EXPECT_EQ(live.simulation().cloths()[0].level(), 6);
}

TEST_F(LiveQuality, IsTakenBack) {
  command(protocol::Quality{0.05, std::nullopt});
  study();
  const int own = [] {
    LiveScene plain(hung_cloth(), protocol::Limits{});
    Reader viewer;
    plain.add_viewer(viewer.viewer, viewer.viewer->enter());
    plain.step();
    return plain.simulation().report(0).substeps;
  }();
  ASSERT_NE(own, 10);
  EXPECT_EQ(substeps(), 10);
  command(protocol::Quality{});
  EXPECT_EQ(other.last("event", "quality").at("wish"), json::object());
  EXPECT_EQ(quality().at("state"), "own");
  EXPECT_EQ(quality().at("integrator"), "bdf2");
  EXPECT_EQ(substeps(), own);
}

TEST_F(LiveQuality, OutlivesAReset) {
  command(protocol::Quality{0.05, std::nullopt});
  study();
  command(protocol::Reset{});
  EXPECT_EQ(substeps(), 10);
}

TEST_F(LiveQuality, OfWhichNothingCouldBeLearntIsUnavailable) {
  command(protocol::Quality{0.05, std::nullopt});
  command(protocol::Cost{});
  live.take_study({{}, "too large"});
  drain();
  EXPECT_FALSE(live.wants_study());
  EXPECT_EQ(quality().at("state"), "unavailable");
  EXPECT_EQ(reader.last("curve").at("why"), "too large");
  EXPECT_EQ(reader.last("curve").at("levels"), json::array());
  live.step();
  EXPECT_EQ(live.simulation().step_count(), 1U);
}

TEST_F(LiveQuality, CostIsToldToThoseWhoAskedAndOnlyOnce) {
  EXPECT_EQ(command(protocol::Cost{}).at("op"), "ok");
  EXPECT_TRUE(live.wants_study());
  EXPECT_EQ(quality().at("state"), "measuring");
  EXPECT_EQ(reader.last("curve"), nullptr);
  study();
  EXPECT_EQ(other.last("curve"), nullptr);
  const json curve = reader.last("curve");
  EXPECT_EQ(curve.at("frames"), 30);
  EXPECT_EQ(curve.at("chaotic"), false);
  ASSERT_EQ(curve.at("levels").size(), 3U);
  const json& level = curve.at("levels").at(1);
  EXPECT_EQ(level.at("level"), 5);
  EXPECT_EQ(level.at("space"), 0.005);
  EXPECT_EQ(level.at("points").at(1), json({{"integrator", "xpbd"},
                                            {"setting", "10 substeps"},
                                            {"ms", 8.0},
                                            {"error", 0.01},
                                            {"span", 10.0},
                                            {"best", true},
                                            {"own", false}}));
  EXPECT_EQ(level.at("points").at(3).at("own"), true);
  EXPECT_EQ(level.at("points").at(3).at("best"), false);
  reader.texts.clear();
  live.step();
  drain();
  EXPECT_EQ(reader.last("curve"), nullptr);
  command(protocol::Cost{});  // known by now
  EXPECT_NE(reader.last("curve"), nullptr);
}

TEST_F(QualityOfAScene, IsStudiedOnceItHasViewers) {
  EXPECT_TRUE(live.wants_study());
  LiveScene empty(kept_to({0.05, std::nullopt}), protocol::Limits{});
  EXPECT_FALSE(empty.wants_study());
  EXPECT_EQ(quality().at("state"), "measuring");
  study();
  EXPECT_EQ(substeps(), 10);
}

TEST_F(QualityOfAScene, ComesBackWhenAViewersWishIsTakenBack) {
  study();
  command(protocol::Quality{0.002, std::nullopt});
  EXPECT_EQ(substeps(), 20);
  command(protocol::Quality{});
  EXPECT_EQ(other.last("event", "quality").at("wish"), json({{"max_error", 0.05}}));
  EXPECT_EQ(substeps(), 10);
}

}  // namespace
}  // namespace weft::host::test
