/// What viewers are told when a step goes wrong, and when a cloth sleeps.
#include <cmath>
#include <random>

#include "fixtures.h"
#include "host/guard_log.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

using namespace protocol;  // NOLINT(google-build-using-namespace): the commands' names

class Guarded : public ::testing::Test {
 protected:
  explicit Guarded(const scene::Scene& scene) : live(scene, Limits{}) {
    visit = reader.viewer->enter();
    live.add_viewer(reader.viewer, visit);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      live.step();
      live.publish(0);
      reader.drain();
    }
  }
  json stats() {
    live.send_stats(1);
    reader.drain();
    return reader.last("stats");
  }
  int told(const std::string& code) const {
    return static_cast<int>(std::count_if(reader.texts.begin(), reader.texts.end(), [&](const json& text) {
      return text.value("op", "") == "notice" && text.value("code", "") == code;
    }));
  }
  void command(SceneCommand command) {
    live.apply(reader.viewer, visit, {1, std::move(command)});
    reader.drain();
  }
  void expect_finite_frames() const {
    ASSERT_FALSE(reader.frames.empty());
    for (const auto& frame : reader.frames) {
      for (const auto& cloth : frame.cloths) {
        for (const float value : cloth.positions) ASSERT_TRUE(std::isfinite(value));
      }
    }
  }

  LiveScene live;
  Reader reader;
  std::uint64_t visit = 0;
};

/// One substep of 1/60 s where the stiffest mode allows 0.2 ms.
class Unstable : public Guarded {
 protected:
  static scene::Scene explosive() {
    scene::Scene scene = hung_cloth();
    scene.simulation.cloths[0].material.structural = 50000;
    scene.simulation.cloths[0].perturbation = 0.01;
    scene.simulation.integrator = SymplecticEulerDescription{1, 0.9};
    return scene;
  }
  Unstable() : Guarded(explosive()) {}
};

TEST_F(Unstable, ScenesGoOnAndTell) {
  steps(200);
  EXPECT_EQ(live.simulation().step_count(), 200U);
  EXPECT_FALSE(live.paused());
  EXPECT_EQ(reader.frames.back().stamp.frame, 200U);
  expect_finite_frames();
  ASSERT_GE(told("recovered"), 1);
  EXPECT_EQ(told("frozen"), 0);
  const std::string message = reader.last("notice", "recovered").at("message");
  EXPECT_EQ(message.substr(0, 12), "cloth: step ");
  EXPECT_NE(message.find("made again by backward Euler with 4 substeps"), std::string::npos) << message;
  const json guard = stats().at("guard");
  EXPECT_GE(guard.at("redone"), told("recovered"));
  EXPECT_EQ(guard.at("frozen"), 0);
  EXPECT_EQ(static_cast<int>(live.take_warnings().size()), told("recovered"));
  EXPECT_TRUE(live.take_warnings().empty());
  // At most one in 60 steps.
  EXPECT_LE(told("recovered"), 1 + 200 / 60);
}

TEST_F(Unstable, AResetForgetsIt) {
  steps(100);
  ASSERT_TRUE(stats().contains("guard"));
  command(Reset{});
  EXPECT_FALSE(stats().contains("guard"));
}

/// A fall that gains 1e10 m/s a step: no method makes a good step of it.
class Impossible : public Guarded {
 protected:
  static scene::Scene falling() {
    scene::Scene scene = hung_cloth();
    scene.simulation.cloths.push_back(scene.simulation.cloths[0]);
    scene.simulation.cloths[1].name = "held";
    scene.simulation.cloths[1].pins = {{0, 1, 0, 1}};  // all of it: gravity does not matter
    scene.simulation.effects = {GravityEffect{{0, -6e11, 0}}};
    return scene;
  }
  Impossible() : Guarded(falling()) {}
};

TEST_F(Impossible, OneClothIsFrozenTheSceneGoesOn) {
  steps(20);
  EXPECT_EQ(live.simulation().step_count(), 20U);
  EXPECT_FALSE(live.paused());
  expect_finite_frames();
  EXPECT_EQ(told("frozen"), 1);
  EXPECT_EQ(told("recovered"), 0);
  EXPECT_EQ(reader.last("notice", "frozen").at("message").get<std::string>().substr(0, 19),
            "cloth: step 1 gave ");
  EXPECT_EQ(reader.frames.front().cloths[0].positions, reader.frames.back().cloths[0].positions);
  const json told_stats = stats();
  EXPECT_EQ(told_stats.at("guard"),
            json({{"redone", 0}, {"frozen", 1}, {"balls_stopped", 0}, {"crowded", 0}}));
  EXPECT_EQ(told_stats.at("cloths").at(0).at("state"), "frozen");
  EXPECT_EQ(told_stats.at("cloths").at(0).at("substeps"), 0);
  EXPECT_EQ(told_stats.at("cloths").at(1).at("state"), "awake");
}

TEST_F(Impossible, ViewersWhoComeLaterAreToldToo) {
  steps(5);
  Reader late;
  live.add_viewer(late.viewer, late.viewer->enter());
  late.drain();
  EXPECT_EQ(late.last("notice", "frozen"), reader.last("notice", "frozen"));
  command(Reset{});
  Reader latest;
  live.add_viewer(latest.viewer, latest.viewer->enter());
  latest.drain();
  EXPECT_EQ(latest.last("notice"), nullptr);
}

class AtRest : public Guarded {
 protected:
  static scene::Scene floating() {
    scene::Scene scene = hung_cloth();
    scene.simulation.wind.speed = 0;
    scene.simulation.effects = {PaperWindEffect{}};
    return scene;
  }
  AtRest() : Guarded(floating()) {}
};

TEST_F(AtRest, StatsTellThatAClothSleeps) {
  steps(59);
  EXPECT_EQ(stats().at("cloths").at(0).at("state"), "awake");
  steps(2);
  EXPECT_EQ(stats().at("cloths").at(0).at("state"), "asleep");
  EXPECT_EQ(stats().at("cloths").at(0).at("substeps"), 0);
  EXPECT_EQ(reader.frames.back().stamp.frame, 61U);  // the clock goes on
  command(WindSet{{0, 0, -1}, 3});
  steps(1);
  EXPECT_EQ(stats().at("cloths").at(0).at("state"), "awake");
  EXPECT_EQ(told("recovered") + told("frozen"), 0);
}

/// A cloth of 1 m, all of it within `half`, m, of one point.
void pack(Simulation<float>& simulation, float half) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-half, half);
  Cloth<float>& cloth = simulation.cloths()[0];
  auto& position = cloth.particles().position;
  const Grid& grid = cloth.particles().grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      for (auto* component : {&position.x, &position.y, &position.z}) component->at(r, c) = value(random);
    }
  }
  cloth.moved_from_outside();
}

std::vector<std::string> codes(const std::vector<GuardLog::Notice>& notices) {
  std::vector<std::string> all;
  for (const GuardLog::Notice& notice : notices) all.push_back(notice.code);
  return all;
}

TEST(GuardLogs, TellOfClothThatIsLetThroughClothOnceInAWhile) {
  SimulationDescription scene = hung_cloth().simulation;
  scene.cloths[0].pins = {{0, 1, 0, 1}};  // all of it: there is nothing to solve
  scene.cloths[0].initial_level = 4;      // 256 cells of 13 pairs with each other
  scene.effects = {ClothContactEffect{}};
  Simulation<float> simulation(scene);
  GuardLog log;
  simulation.step();
  EXPECT_TRUE(log.stepped(simulation).empty());
  EXPECT_EQ(log.stats_json(), nullptr);
  pack(simulation, 1e-3F);
  simulation.step();
  EXPECT_EQ(codes(log.stepped(simulation)), std::vector<std::string>{"crowded"});
  EXPECT_EQ(log.stats_json().at("crowded"), 1);
  EXPECT_TRUE(codes(log.stepped(simulation)).empty());  // as if the next step did the same
  EXPECT_EQ(log.stats_json().at("crowded"), 2);
}

}  // namespace
}  // namespace weft::host::test
