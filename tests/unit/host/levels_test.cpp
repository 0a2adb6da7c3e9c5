/// Who sees which level, what is simulated, and what is encoded.
#include <cmath>

#include "cloth/levels/refine.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

SceneRequest camera(double distance) { return {std::nullopt, protocol::Camera{distance, std::nullopt}}; }
SceneRequest eye(double x, double y, double z) {
  return {std::nullopt, protocol::Camera{std::nullopt, protocol::Vector{x, y, z}}};
}

class Levels : public ::testing::Test {
 protected:
  std::uint64_t enter(Reader& reader) {
    const auto visit = reader.viewer->enter();
    live.add_viewer(reader.viewer, visit);
    return visit;
  }
  std::uint64_t enter(Reader& reader, double distance) {
    const auto visit = enter(reader);
    live.apply(reader.viewer, visit, camera(distance));
    return visit;
  }
  void step() {
    live.step();
    live.publish(0);
  }
  int simulated_level() const { return live.simulation().cloths()[0].level(); }

  LiveScene live{hung_cloth(), protocol::Limits{}};
};

int level_shown(Reader& reader) {
  reader.drain();
  return reader.frames.back().cloths[0].level;
}

TEST_F(Levels, EachViewerHasItsOwnAndTheFinestIsSimulated) {
  Reader near, middle, far;
  enter(near, 0.8);
  enter(middle, 5);
  enter(far, 12);
  step();
  const std::vector<std::pair<Reader*, int>> expected{{&near, 6}, {&middle, 5}, {&far, 4}};
  for (const auto& [reader, level] : expected) {
    reader->drain();
    const protocol::ClothRecord& cloth = reader->frames.back().cloths[0];
    EXPECT_EQ(cloth.level, level);
    EXPECT_EQ(cloth.simulated_level, 6);
    EXPECT_EQ(cloth.rows, (1 << level) + 1);
    EXPECT_EQ(cloth.cols, (1 << level) + 1);
  }
}

/// States of 120 steps of a scene that one viewer watches from 12 m, while so many come before each tenth
/// step and leave five steps later. They say nothing, or that they are farther away.
std::vector<std::uint64_t> states_while_others_come(int others, bool farther) {
  LiveScene scene(hung_cloth(), protocol::Limits{});
  Reader observer;
  const auto first = observer.viewer->enter();
  scene.add_viewer(observer.viewer, first);
  scene.apply(observer.viewer, first, camera(12));
  std::vector<Reader> readers(static_cast<std::size_t>(others));
  std::vector<std::uint64_t> visits(readers.size());
  std::vector<std::uint64_t> states;
  for (int step = 0; step < 120; ++step) {
    for (std::size_t i = 0; i < readers.size(); ++i) {
      if (step % 10 == 0) {
        visits[i] = readers[i].viewer->enter();
        scene.add_viewer(readers[i].viewer, visits[i]);
        if (farther) scene.apply(readers[i].viewer, visits[i], camera(20));
      }
      if (step % 10 == 5) scene.remove_viewer(readers[i].viewer.get(), visits[i]);
    }
    scene.step();
    scene.publish(0);
    states.push_back(state_hash(scene.simulation()));
  }
  return states;
}

TEST_F(Levels, WhoComesChangesNothingUnlessItIsNearer) {
  const auto alone = states_while_others_come(0, false);
  for (const bool farther : {false, true}) EXPECT_EQ(states_while_others_come(50, farther), alone) << farther;
}

TEST_F(Levels, WhereNobodyHasSentItsCameraTheDefaultDistanceDecides) {
  Reader one, other;
  enter(one);
  enter(other);
  step();
  EXPECT_EQ(simulated_level(), 5);
  EXPECT_EQ(level_shown(other), 5);
}

TEST_F(Levels, WhoHasNotSentItsCameraIsShownWhatIsSimulatedForOthers) {
  Reader observer, newcomer;
  enter(observer, 12);
  const auto visit = enter(newcomer);
  step();
  EXPECT_EQ(simulated_level(), 4);
  EXPECT_EQ(level_shown(newcomer), 4);
  live.apply(newcomer.viewer, visit, camera(5));
  step();
  EXPECT_EQ(level_shown(newcomer), 5);
}

TEST_F(Levels, ACoarserLevelHasTheSharedNodesOfTheSimulatedOne) {
  Reader near, far;
  enter(near, 0.5);
  enter(far, 20);
  for (int i = 0; i < 10; ++i) step();
  near.drain();
  far.drain();
  const protocol::ClothRecord& fine = near.frames.back().cloths[0];
  const protocol::ClothRecord& coarse = far.frames.back().cloths[0];
  ASSERT_EQ(fine.cols, 65);
  ASSERT_EQ(coarse.cols, 17);
  const double tolerance =
      0.5 * (double(fine.quantisation.quantum) + double(coarse.quantisation.quantum)) + 1e-6;
  for (int r = 0; r < 17; ++r) {
    for (int c = 0; c < 17; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = [axis](const protocol::ClothRecord& cloth, int row, int col) {
          return double(cloth.positions[static_cast<std::size_t>(3 * (row * cloth.cols + col) + axis)]);
        };
        EXPECT_NEAR(at(coarse, r, c), at(fine, 4 * r, 4 * c), tolerance);
      }
    }
  }
}

TEST_F(Levels, TheSceneGetsCoarserWhenNobodyIsNear) {
  Reader near, far;
  const auto visit = enter(near, 0.5);
  enter(far, 12);
  step();
  EXPECT_EQ(simulated_level(), 6);
  live.remove_viewer(near.viewer.get(), visit);
  step();
  EXPECT_EQ(simulated_level(), 4);
  far.drain();
  EXPECT_EQ(far.frames.back().cloths[0].simulated_level, 4);
}

TEST_F(Levels, AViewerThatComesNearerIsServedFromTheNextStepOn) {
  Reader reader;
  const auto visit = enter(reader, 12);
  step();
  EXPECT_EQ(level_shown(reader), 4);
  live.apply(reader.viewer, visit, camera(0.8));
  step();
  EXPECT_EQ(level_shown(reader), 6);
}

TEST_F(Levels, BeforeItsFirstCommandAViewerIsAtTheScenesDistance) {
  Reader reader;
  enter(reader);
  step();
  EXPECT_EQ(level_shown(reader), 5);  // 5 m: within Table 1's 1 m and 10 m
  EXPECT_EQ(reader.texts[0].at("op"), "scene");
  EXPECT_EQ(reader.texts[0].at("camera").at("level"), json({5}));
}

TEST_F(Levels, AnEyeIsAsFarAsTheClothsCentre) {
  Reader reader;
  const auto visit = enter(reader);
  const Vec3 centre = live.simulation().centre(0);  // the middle of the sheet before the first step
  live.apply(reader.viewer, visit, eye(centre.x() + 0.6, centre.y(), centre.z() + 0.7));  // 0.92 m
  step();
  EXPECT_EQ(level_shown(reader), 6);
  live.apply(reader.viewer, visit, eye(8, 0, 7));  // 10.6 m
  step();
  EXPECT_EQ(level_shown(reader), 4);
}

TEST(LevelsHysteresis, HoldsALevelUntilTheThresholdIsPassedByItsShare) {
  scene::Scene scene = hung_cloth();
  scene.simulation.level_policy.hysteresis = 0.1;
  LiveScene live(scene, protocol::Limits{});
  Reader reader;
  const auto visit = reader.viewer->enter();
  live.add_viewer(reader.viewer, visit);
  // Thresholds 1 and 10 m: inwards at 0.9 and 9 m, outwards at 1.1 and 11 m.
  const std::vector<std::pair<double, int>> path{{5, 5},    {10.5, 5}, {11.5, 4}, {9.5, 4}, {8.5, 5},
                                                 {0.95, 5}, {0.85, 6}, {1.05, 6}, {1.15, 5}};
  for (const auto& [distance, level] : path) {
    live.apply(reader.viewer, visit, camera(distance));
    live.step();
    live.publish(0);
    EXPECT_EQ(level_shown(reader), level) << distance << " m";
  }
}

TEST_F(Levels, ALevelIsEncodedOnceForAllItsViewers) {
  std::vector<Reader> readers(7);
  for (int i = 0; i < 4; ++i) enter(readers[static_cast<std::size_t>(i)], 0.5);
  for (int i = 4; i < 7; ++i) enter(readers[static_cast<std::size_t>(i)], 5);
  step();
  const auto before = live.encoder().encodes();
  for (int i = 0; i < 10; ++i) step();
  EXPECT_EQ(live.encoder().encodes() - before, 20U);  // 10 steps, one cloth at two levels, no balls
  const auto first = readers[0].viewer, second = readers[1].viewer;
  while (first->take()->text) {
  }
  live.step();
  live.publish(0);
  auto take_frame = [](Viewer& viewer) {
    auto next = viewer.take();
    while (next->text) next = viewer.take();
    return next->frame;
  };
  EXPECT_EQ(take_frame(*first)->records[0].get(), take_frame(*second)->records[0].get());
}

TEST_F(Levels, LimitsOfTheClothHold) {
  scene::Scene scene = hung_cloth();
  scene.simulation.cloths[0].min_level = 5;
  scene.simulation.cloths[0].max_level = 5;
  scene.simulation.cloths[0].initial_level = 5;
  LiveScene fixed(scene, protocol::Limits{});
  for (const double distance : {0.1, 100.0}) {
    Reader reader;
    const auto visit = reader.viewer->enter();
    fixed.add_viewer(reader.viewer, visit);
    fixed.apply(reader.viewer, visit, camera(distance));
    fixed.step();
    fixed.publish(0);
    EXPECT_EQ(level_shown(reader), 5);
  }
}

TEST(FinestSendableLevel, KeepsTheWorstRecordWithinTheLimit) {
  // 19 bits a value at worst: 3 * 257^2 * 19 / 8 = 470 587 bytes and a little; four times that for 513^2.
  EXPECT_EQ(finest_sendable_level({1, 1}, 1048576), 8);
  EXPECT_EQ(finest_sendable_level({2, 2}, 1048576), 7);
  EXPECT_EQ(finest_sendable_level({1, 1}, 470000), 7);
}

/// Every coordinate of every frame of a run, against the simulation that made it.
TEST(Frames, DecodeToWithinHalfAQuantum) {
  scene::Scene scene = hung_cloth();
  scene.simulation.balls = {{{0, -0.3, 0.5}, 0.2, {0, 0, -1}, BallDescription::Motion::kinematic, 1, 0, {}}};
  LiveScene live(scene, protocol::Limits{});
  std::vector<std::pair<Reader, double>> viewers(3);
  viewers[0].second = 0.5;
  viewers[1].second = 5;
  viewers[2].second = 50;
  for (auto& [reader, distance] : viewers) {
    const auto visit = reader.viewer->enter();
    live.add_viewer(reader.viewer, visit);
    live.apply(reader.viewer, visit, camera(distance));
  }
  std::size_t compared = 0;
  for (int i = 0; i < 90; ++i) {
    live.step();
    live.publish(0);
    const Particles<float>& truth = live.simulation().cloths()[0].particles();
    for (auto& [reader, distance] : viewers) {
      reader.drain();
      ASSERT_EQ(reader.frames.size(), static_cast<std::size_t>(i + 1));
      const protocol::Frame& frame = reader.frames.back();
      EXPECT_EQ(frame.stamp.frame, live.simulation().step_count());
      EXPECT_EQ(frame.stamp.time, live.simulation().time());
      ASSERT_EQ(frame.balls.size(), 1U);
      EXPECT_EQ(frame.balls[0].position[2],
                static_cast<float>(live.simulation().colliders().balls()[0].position.z()));
      const protocol::ClothRecord& cloth = frame.cloths[0];
      const int stride = (truth.grid().cols - 1) / (cloth.cols - 1);
      const double half = 0.5 * double(cloth.quantisation.quantum);
      for (int r = 0; r < cloth.rows; ++r) {
        for (int c = 0; c < cloth.cols; ++c) {
          const Vec3 p = truth.position_at(r * stride, c * stride);
          for (int axis = 0; axis < 3; ++axis) {
            const float shown = cloth.positions[static_cast<std::size_t>(3 * (r * cloth.cols + c) + axis)];
            // The decoder rounds to f32: half a unit in the last place on top.
            ASSERT_LE(std::abs(double(shown) - p[axis]), half + std::ldexp(std::abs(double(shown)), -24));
            ++compared;
          }
        }
      }
    }
  }
  EXPECT_EQ(compared, 90U * 3U * (65U * 65U + 33U * 33U + 17U * 17U));
}

TEST(Frames, ShortStepsShowEveryNth) {
  scene::Scene scene = hung_cloth();
  scene.simulation.time_step = 1.0 / 240.0;
  LiveScene live(scene, protocol::Limits{});
  Reader reader;
  live.add_viewer(reader.viewer, reader.viewer->enter());
  live.publish(0);
  for (int i = 0; i < 12; ++i) {
    live.step();
    live.publish(0);
    reader.drain();
  }
  std::vector<std::uint32_t> shown;
  for (const auto& frame : reader.frames) shown.push_back(frame.stamp.frame);
  EXPECT_EQ(shown, (std::vector<std::uint32_t>{0, 4, 8, 12}));  // 60 frames a second
}

}  // namespace
}  // namespace weft::host::test
