// The presets are good scenes, and those of the paper carry its numbers.
#include "fixtures.h"

namespace weft::scene::test {
namespace {

TEST(Presets, AreListedInOrder) {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"flag",          "flag-gusts", "curtain",        "fan",
                                      "tablecloth",    "silk",       "round-table",    "cape",
                                      "walker",        "sail",       "trampoline",     "washing-line",
                                      "towel",         "hide",       "cushion",        "pillow",
                                      "paper-screen",  "swing",      "zheng2020-wind", "zheng2020-distance",
                                      "zheng2020-ball"}));
}

TEST(Presets, AreGoodScenesThatSayWhatWasChosen) {
  for (const Preset& preset : presets()) {
    SCOPED_TRACE(preset.name);
    const Scene scene = good(load(std::string(preset.name)));
    EXPECT_EQ(scene.name, preset.name);
    EXPECT_NE(scene.title, scene.name);
    EXPECT_FALSE(scene.notes.empty());
  }
}

// Table 1: k = 20, lambda = 1, l_close = 1 m, l_far = 10 m; section 3.1: 64, 32, 16 cells a side; Eqs. 1
// to 6.
TEST(Presets, ZhengScenesCarryThePapersNumbers) {
  for (const std::string name : {"zheng2020-wind", "zheng2020-distance", "zheng2020-ball"}) {
    SCOPED_TRACE(name);
    const SimulationDescription simulation = good(load(name)).simulation;
    ASSERT_EQ(simulation.cloths.size(), 1u);
    const ClothDescription& cloth = simulation.cloths[0];
    EXPECT_EQ(cloth.material.damping, 20);
    EXPECT_EQ(cloth.discretization, Discretization::paper);
    EXPECT_EQ(cloth.base_cells, (BaseCells{1, 1}));
    ASSERT_EQ(simulation.effects.size(), 3u);
    EXPECT_EQ(std::get<GravityEffect>(simulation.effects[0]).acceleration, standard_gravity());
    EXPECT_TRUE(std::holds_alternative<DampingEffect>(simulation.effects[1]));
    EXPECT_EQ(std::get<PaperWindEffect>(simulation.effects[2]).factor, 1);
    EXPECT_EQ(simulation.wind.direction, Vec3(0, 0, -1));  // into the screen
    EXPECT_EQ(simulation.wind.speed, 1);                   // at which Eq. 4 holds to the letter
    EXPECT_EQ(simulation.level_policy.thresholds, (std::vector<double>{1, 10}));
    EXPECT_EQ(simulation.level_policy.levels, (std::vector<int>{6, 5, 4}));
    EXPECT_EQ(simulation.level_policy.hysteresis, 0);
    EXPECT_EQ(simulation.balls.size(), name == "zheng2020-ball" ? 1u : 0u);
  }
  EXPECT_EQ(good(load("zheng2020-wind")).camera_distance, 1);
}

}  // namespace
}  // namespace weft::scene::test
