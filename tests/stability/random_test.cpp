// Random scenes: twenty fixed ones, eight of them in the nightly tests alone, the ones that a repair is known
// to have mended and, in the nightly tests, 2,000 new ones from the environment's WEFT_SEED on. One that
// fails is shrunk and written beside the table; it goes into regressions/, and as long as it fails onto
// open_failures.txt.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "open_failures.h"
#include "random_scenes.h"
#include "random_surroundings.h"
#include "scene/scene.h"
#include "scene_json.h"

namespace weft::stability {
namespace {

void check_seeds(std::uint64_t first, std::uint64_t count, int max_level) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const SimulationDescription drawn = random_scene(seed, max_level);
    const std::optional<Failure> failure = check(drawn);
    const bool open = is_open("seed_" + std::to_string(seed));
    EXPECT_FALSE(open && !failure) << "seed " << seed << " passes now: take it off open_failures.txt";
    if (!failure || open) continue;
    const SimulationDescription small = shrink(drawn, check);
    const std::filesystem::path folder = WEFT_STABILITY_REPORT;
    std::filesystem::create_directories(folder);
    const auto file = folder / ("seed_" + std::to_string(seed) + ".json");
    std::ofstream(file) << scene_json(small).dump(1) << '\n';
    std::ofstream(folder / ("seed_" + std::to_string(seed) + "_whole.json"))
        << scene_json(drawn).dump(1) << '\n';
    ADD_FAILURE() << "seed " << seed << ": " << failure->what << "\nshrunk: " << check(small)->what << ", "
                  << file;
  }
}

class RandomScenes : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomScenes, AreFiniteAndBounded) { check_seeds(GetParam(), 2, 4); }
INSTANTIATE_TEST_SUITE_P(Stability, RandomScenes, ::testing::Values<std::uint64_t>(19));
INSTANTIATE_TEST_SUITE_P(Slow, RandomScenes, ::testing::Range<std::uint64_t>(5, 11, 2));
INSTANTIATE_TEST_SUITE_P(Nightly, RandomScenes, ::testing::Values<std::uint64_t>(1, 3, 11, 13, 15, 17));

#ifdef WEFT_SANITIZED
constexpr std::uint64_t kNewScenes = 100;
#else
constexpr std::uint64_t kNewScenes = 2000;
#endif

std::uint64_t first_new_seed() {
  const char* seed = std::getenv("WEFT_SEED");
  return seed != nullptr ? std::strtoull(seed, nullptr, 10) : 1000;
}

class NewScenes : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(NewScenes, AreFiniteAndBounded) { check_seeds(first_new_seed() + GetParam(), 10, 5); }
INSTANTIATE_TEST_SUITE_P(Nightly, NewScenes, ::testing::Range<std::uint64_t>(0, kNewScenes, 10));

// Of these, those that shrinking makes fail otherwise (regressions/) or is not worth while for, as they take
// a second: in 1147 what a solve gained was rounding, 3.5 mJ; in 1385 strips that slid along each other were
// taken for touching, 10 kJ; 2064's layers were held as a split had left them, not settled, 21 J in the
// springs; in 2298 a Newton iteration went astray, 85 J. In 1219 merges lifted a sheet from its pins, 15 mJ
// of 53 g. In 1276 a split joined torn pieces 100 m apart, 1.5e10 J; in 2453 rounding took flakes on a plane
// away, at 1.8e9 m/s. In 2406 the net alone held a sheet that another one swept past, 36 J.
class RepairedScenes : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RepairedScenes, AreFiniteAndBounded) { check_seeds(GetParam(), 1, 5); }
INSTANTIATE_TEST_SUITE_P(Nightly, RepairedScenes,
                         ::testing::Values<std::uint64_t>(1147, 1219, 1276, 1385, 2064, 2298, 2406, 2453));

TEST(RandomScene, IsTheSameForTheSameSeed) {
  EXPECT_EQ(scene_json(random_scene(7, 4)), scene_json(random_scene(7, 4)));
  EXPECT_NE(scene_json(random_scene(7, 4)), scene_json(random_scene(8, 4)));
}

// What a new effect or shape adds to its variant is missed here until it is drawn.
TEST(RandomScene, HundredSeedsHaveEverything) {
  std::set<std::size_t> effects, shapes, integrators;
  int paths = 0, bodies = 0, gusts = 0, eddies = 0, hands = 0, switches = 0, bags = 0, gas = 0;
  int zones = 0, pairs = 0, touching_pairs = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const SimulationDescription drawn = random_scene(seed, 4);
    for (const EffectDescription& each : drawn.effects) {
      effects.insert(each.index());
      const auto* inflation = std::get_if<InflationEffect>(&each);
      gas += inflation != nullptr && inflation->volume.has_value();
    }
    bags += drawn.cloths[0].sewn;
    zones += !drawn.wind.zones.empty();
    const bool has_two = drawn.cloths.size() > 1;
    pairs += has_two;
    touching_pairs +=
        has_two && std::any_of(drawn.effects.begin(), drawn.effects.end(), [](const auto& each) {
          return std::holds_alternative<ClothContactEffect>(each);
        });
    for (const ObstacleDescription& each : drawn.obstacles) {
      shapes.insert(each.shape.index());
      paths += !each.path.empty();
      bodies += each.body.has_value();
    }
    integrators.insert(drawn.integrator.index());
    gusts += drawn.wind.gusts.intensity > 0;
    eddies += drawn.wind.turbulence.intensity > 0;
    hands += hand_of(drawn).has_value();
    switches += kept_effects(drawn).has_value();
  }
  EXPECT_EQ(effects.size(), std::variant_size_v<EffectDescription>);
  EXPECT_EQ(shapes.size(), std::variant_size_v<decltype(ObstacleDescription::shape)>);
  EXPECT_EQ(integrators.size(), std::variant_size_v<IntegratorDescription>);
  for (const int drawn :
       {paths, bodies, gusts, eddies, hands, switches, bags, gas, zones, pairs, touching_pairs}) {
    EXPECT_GT(drawn, 5);
  }
}

TEST(RandomScene, IsASceneFile) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const SimulationDescription drawn = random_scene(seed, 4);
    const scene::Result read = scene::from_json(scene_json(drawn), "drawn");
    if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&read)) {
      ADD_FAILURE() << "seed " << seed << ": " << problems->front().text();
    } else {
      // Read back it is the same scene, to the rounding of a quaternion and a direction made unit again.
      const SimulationDescription& again = std::get<scene::Scene>(read).simulation;
      EXPECT_EQ(again.balls.size(), drawn.balls.size());
      EXPECT_EQ(again.obstacles.size(), drawn.obstacles.size());
      EXPECT_EQ(again.cloths.size(), drawn.cloths.size());
      EXPECT_EQ(scene_json(again)["cloths"][0]["material"], scene_json(drawn)["cloths"][0]["material"]);
      EXPECT_EQ(scene_json(again)["integrator"], scene_json(drawn)["integrator"]);
      EXPECT_EQ(scene_json(again)["effects"], scene_json(drawn)["effects"]);
    }
  }
}

SimulationDescription with_three_balls(const Check& made_up) {
  std::uint64_t seed = 1;
  while (!made_up(random_scene(seed, 4)) || random_scene(seed, 4).balls.size() < 3) ++seed;
  return random_scene(seed, 4);
}

// A failure that hangs on two things at once is shrunk to these two.
TEST(Shrink, LeavesWhatTheFailureNeeds) {
  const auto made_up = [](const SimulationDescription& scene) -> std::optional<Failure> {
    if (scene.balls.empty() || scene.cloths[0].material.structural.most() <= 100) return {};
    return Failure{Failure::Kind::energy, "a ball and a stiff cloth"};
  };
  const SimulationDescription small = shrink(with_three_balls(made_up), made_up);
  EXPECT_TRUE(made_up(small));
  EXPECT_EQ(small.balls.size(), 1u);
  EXPECT_EQ(small.effects.size(), 0u);
  EXPECT_EQ(small.cloths[0].pins.size(), 0u);
  EXPECT_EQ(small.cloths[0].max_level, kMinLevel);
  EXPECT_EQ(small.cloths[0].material, Material{});
}

// Without balls this fails, too, but otherwise: two balls are what the failure needs.
TEST(Shrink, HoldsToTheKindOfFailure) {
  const auto made_up = [](const SimulationDescription& scene) -> std::optional<Failure> {
    if (scene.balls.size() < 2) return Failure{Failure::Kind::not_finite, "too few balls"};
    return Failure{Failure::Kind::energy, "balls"};
  };
  const SimulationDescription small = shrink(with_three_balls(made_up), made_up);
  EXPECT_EQ(small.balls.size(), 2u);
  EXPECT_EQ(small.effects.size(), 0u);
  EXPECT_EQ(small.seed, 1u);
}

TEST(Shrink, ThrowsForASceneThatHolds) {
  const auto holds = [](const SimulationDescription&) { return std::optional<Failure>(); };
  EXPECT_THROW(shrink(random_scene(1, 4), holds), std::invalid_argument);
}

class Regressions : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(Regressions, StayRepaired) {
  const scene::Result read = scene::load(GetParam().string());
  ASSERT_TRUE(std::holds_alternative<scene::Scene>(read));
  const std::optional<Failure> failure = check(std::get<scene::Scene>(read).simulation);
  if (!is_open(GetParam().stem().string())) {
    EXPECT_FALSE(failure) << failure->what;
  } else if (failure) {
    GTEST_SKIP() << "known to fail: " << failure->what;
  } else {
    ADD_FAILURE() << "passes now: take it off open_failures.txt";
  }
}

std::vector<std::filesystem::path> regression_files(const char* folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(WEFT_STABILITY_REGRESSIONS) + folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Slow, Regressions, ::testing::ValuesIn(regression_files("")),
                         [](const auto& each) { return each.param.stem().string(); });
// Those that take seven seconds or more.
INSTANTIATE_TEST_SUITE_P(Nightly, Regressions, ::testing::ValuesIn(regression_files("/nightly")),
                         [](const auto& each) { return each.param.stem().string(); });

}  // namespace
}  // namespace weft::stability
