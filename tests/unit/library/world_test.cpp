// The library's face: scenes that are loaded, stepped and changed as a whole.
#include <algorithm>

#include "cloth/core/subnormals.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "scene/scene.h"

namespace weft {
namespace {

TEST(World, LoadsEveryPreset) {
  const std::vector<std::string> names = World::presets();
  EXPECT_EQ(names.size(), scene::presets().size());
  for (const std::string& name : names) {
    const World world = World::load(name);
    EXPECT_FALSE(world.cloths().empty()) << name;
    EXPECT_EQ(world.time(), 0) << name;
  }
}

TEST(World, SaysAllThatIsWrongWithAScene) {
  try {
    World::load("flag", {"/cloths/0/material/density=-1", "/wind/speed=1000"});
    FAIL() << "two values are out of range";
  } catch (const SceneError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    std::vector<std::string> paths;
    for (const SceneError::Problem& problem : error.problems()) paths.push_back(problem.path);
    std::sort(paths.begin(), paths.end());
    EXPECT_EQ(paths, (std::vector<std::string>{"/cloths/0/material/density", "/wind/speed"}));
    EXPECT_NE(std::string(error.what()).find("flag"), std::string::npos) << error.what();
  }
  EXPECT_THROW(World::parse("{"), SceneError);
  EXPECT_THROW(World::load("no-such-scene"), SceneError);
}

TEST(World, StepsAsTheSimulationBehindIt) {
  const FlushedSubnormals flushed;
  const auto described = scene::load("flag");
  Simulation<float> simulation(std::get<scene::Scene>(described).simulation);
  for (int i = 0; i < 20; ++i) simulation.step();
  World world = World::load("flag");
  world.step(20);
  EXPECT_EQ(world.hash(), state_hash(simulation));
  EXPECT_DOUBLE_EQ(world.time(), 20 * world.time_step());
}

TEST(World, IsTheSameOnAnyNumberOfThreads) {
  World one = World::load("washing-line"), two = World::load("washing-line");
  one.use_threads(1);
  two.use_threads(2);
  one.step(10);
  two.step(10);
  EXPECT_EQ(one.hash(), two.hash());
}

TEST(World, BeginsAnew) {
  World world = World::parse(kFalling);
  const std::uint64_t start = world.hash();
  world.set_effect("gravity", false);
  world.cloth("sheet").set_level(3);
  world.add_ball({.position = {9, 0, 0}});
  world.step(5);
  EXPECT_NE(world.hash(), start);
  world.reset();
  EXPECT_EQ(world.hash(), start);
  EXPECT_EQ(world.effects(), (std::vector<std::string>{"gravity", "damping"}));
  EXPECT_EQ(world.balls().size(), 1U);
}

TEST(World, AnEyeDecidesTheLevels) {
  World world = World::parse(kFalling);
  // Table 1's kind: nearer than 1 m, up to 10 m, and beyond.
  const std::vector<std::pair<double, int>> cases = {{0.5, 5}, {5, 4}, {50, 3}};
  for (const auto& [distance, level] : cases) {
    const Vector centre = world.cloth("sheet").centre();
    world.look_from({centre[0], centre[1], centre[2] + distance});
    world.step();
    EXPECT_EQ(world.cloth("sheet").level(), level) << distance << " m";
  }
}

TEST(World, AnEffectThatIsOffIsNotSimulated) {
  World world = World::parse(kFalling);
  world.set_effect("gravity", false);
  EXPECT_EQ(world.effects(), std::vector<std::string>{"damping"});
  world.step(30);
  EXPECT_EQ(world.cloth("sheet").centre(), (Vector{0, 0, 0}));
  world.set_effect("gravity", true);
  world.step(30);
  EXPECT_LT(world.cloth("sheet").centre()[1], -0.5);
}

TEST(World, NumbersOfEffectsAreThoseOfSceneFiles) {
  World world = World::parse(kFalling);
  world.set_parameter("gravity", "acceleration", {0, 0, 3});
  world.step(60);
  // a t^2 / 2 after 1 s, less what the damping takes; nothing along y.
  EXPECT_NEAR(world.cloth("sheet").centre()[2], 1.5, 0.3);
  EXPECT_NEAR(world.cloth("sheet").centre()[1], 0, 1e-6);
}

TEST(World, WindHasTheVelocityThatItIsGiven) {
  World world = World::load("flag", {"/wind/speed=0"});
  World wanted = World::load("flag", {"/wind/speed=6", "/wind/direction=[0,0,1]"});
  world.set_wind({0, 0, 6});
  world.step(20);
  wanted.step(20);
  EXPECT_EQ(world.hash(), wanted.hash());
}

TEST(World, RefusesWhatItCannotTakeAndNamesIt) {
  World world = World::parse(kFalling);
  const std::uint64_t before = world.hash();
  EXPECT_EQ(error_of([&] { world.step(-1); }), "count is -1; must be from 0 to 1000000000");
  EXPECT_EQ(error_of([&] { world.use_threads(0); }), "count is 0; must be from 1 to 1024");
  EXPECT_EQ(error_of([&] { world.cloth("flag"); }), "name is \"flag\"; must be one of sheet");
  EXPECT_EQ(error_of([&] { world.set_wind({0, 2, 0}); }), "no effect of the scene feels wind");
  World flag = World::load("flag");
  EXPECT_EQ(error_of([&] {
              flag.set_wind({0, 200, 0});
            }),
            "the velocity's size is 200; must be from 0 to 100 m/s");
  EXPECT_EQ(error_of([&] {
              world.set_wind_zone(1, {0, 0, 0});
            }),
            "zone is 1; the wind has 0 zones, counted from 0");
  EXPECT_EQ(error_of([&] { world.set_effect("wool", false); }),
            "effect is \"wool\"; must be one of gravity, damping");
  EXPECT_EQ(error_of([&] { world.set_parameter("gravity", "mass", {1}); }),
            "parameter is \"mass\"; must be one of acceleration");
  EXPECT_EQ(error_of([&] { world.set_parameter("gravity", "acceleration", {1}); }),
            "acceleration is of 1 numbers; must be of 3");
  EXPECT_EQ(error_of([&] {
              world.look_from({0, std::numeric_limits<double>::quiet_NaN(), 0});
            }),
            "y of eye is nan; must be from -10000 to 10000 m");
  EXPECT_EQ(world.hash(), before);
}

}  // namespace
}  // namespace weft
