#include "study/effects.h"

#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "study/trajectory.h"

namespace weft::study::test {
namespace {

// What each costs is the machine's affair: only what is listed, and that it adds up, is tested.
TEST(Effects, AreTheScenesInItsOrder) {
  SimulationDescription description = swing();
  description.effects = {AerodynamicsEffect{}, GravityEffect{}};
  int frames = 0;
  const EffectsStudy study = study_effects(description, 4, 8, [&] { ++frames; });
  EXPECT_EQ(frames, 8);
  EXPECT_EQ(study.level, 4);
  ASSERT_EQ(study.effects.size(), 2u);
  EXPECT_EQ(study.effects[0].name, "aerodynamics");
  EXPECT_EQ(study.effects[1].name, "gravity");
  EXPECT_GT(study.all, 0);
  EXPECT_GT(study.rest, 0);
  EXPECT_EQ(study.contact, 0);  // no balls
  EXPECT_TRUE(study.parts.empty());
}

// Gusts, turbulence, zones and friction have a line each where a scene has them, in this order.
TEST(Effects, PartsAreThoseOfTheScene) {
  const auto parts = [](const SimulationDescription& description) {
    std::vector<std::string_view> names;
    for (const EffectCost& part : study_effects(description, 3, 2, kNothing).parts)
      names.push_back(part.name);
    return names;
  };
  using Names = std::vector<std::string_view>;
  SimulationDescription description = swing();
  description.effects = {AerodynamicsEffect{}, GravityEffect{}};
  description.wind.speed = 2;
  EXPECT_EQ(parts(description), Names());
  description.wind.turbulence.intensity = 0.2;
  EXPECT_EQ(parts(description), Names{"turbulence"});
  description.wind.gusts.intensity = 0.2;
  description.wind.zones = {WindZone{}};
  EXPECT_EQ(parts(description), (Names{"gusts", "turbulence", "wind zones"}));
  description.wind = {};
  description.balls = {BallDescription{}};
  description.obstacles = {ObstacleDescription{PlaneDescription{}, {0, -3, 0}}};
  EXPECT_EQ(parts(description), Names());
  description.obstacles[0].friction = 0.3;
  EXPECT_EQ(parts(description), Names{"friction"});
  description.obstacles.clear();
  description.effects.push_back(ClothContactEffect{});
  EXPECT_EQ(parts(description), Names{"friction"});
}

TEST(Effects, ASceneWithoutAnyIsAllRest) {
  SimulationDescription description = swing();
  description.effects.clear();
  const EffectsStudy study = study_effects(description, 3, 4, kNothing);
  EXPECT_TRUE(study.effects.empty());
  EXPECT_GT(study.all, 0);
}

// Pillows and torn paper, too: what is measured begins at the whole state.
TEST(Effects, OfAllPresetsAreMeasuredFromStatesThatGoOnToTheBitSlow) {
  for (const scene::Preset& preset : scene::presets()) {
    SCOPED_TRACE(preset.name);
    const auto loaded = std::get<scene::Scene>(scene::load(std::string(preset.name)));
    const SimulationDescription& description = loaded.simulation;
    Simulation<float> original = at_level<float>(description, 4);
    for (int step = 0; step < 100; ++step) original.step();
    Simulation<float> copy = at_level<float>(description, 4);
    copy.take_state(original);
    for (int step = 0; step < 10; ++step) {
      original.step();
      copy.step();
      ASSERT_EQ(state_hash(copy), state_hash(original)) << step;
    }
    EXPECT_EQ(study_effects(description, 4, 4, kNothing).effects.size(), description.effects.size());
  }
}

TEST(Effects, TableHasALineEach) {
  const std::string text = table({5, 2.0, {{"gravity", 0.5}}, {{"gusts", 0.125}}, 0.25, 1.25});
  EXPECT_EQ(text,
            "level 5                     ms/frame     share\n"
            "  gravity                     0.5000    25.0 %\n"
            "  gusts                       0.1250     6.2 %\n"
            "  contact                     0.2500    12.5 %\n"
            "  springs, integrator         1.2500    62.5 %\n"
            "  all                         2.0000   100.0 %\n");
}

}  // namespace
}  // namespace weft::study::test
