/// What is recorded of a scene is done again to the bit, from any of its states, up to where a file is
/// damaged.
#include "record/replay.h"

#include <gtest/gtest.h>

#include "cloth/world/description_archive.h"
#include "cloth/world/state.h"
#include "cloth/world/state_hash.h"
#include "record/chunks.h"
#include "record/recorder.h"

namespace weft::record {
namespace {

scene::Scene trampoline() {
  return std::get<scene::Scene>(scene::load("trampoline", {"/cloths/0/levels={\"min\": 3, \"max\": 4}"}));
}

/// A recording of all commands there are, with a state after 100 of 200 steps; and the hash after each step.
struct Recorded {
  std::string text;
  std::vector<std::uint64_t> hashes;
};

std::vector<command::Command> all_commands(const Simulation<float>& simulation) {
  BallDescription ball;
  ball.position = Vec3(0, 2, 0);
  ball.radius = 0.2;
  ball.motion = BallDescription::Motion::dynamic;
  Material material = simulation.cloths()[0].description().material;
  material.structural.warp *= 2;
  Wind wind = simulation.wind();
  wind.speed = 2;
  return {command::RequestLevel{0, 3},
          command::ApplyLevel{0},
          command::SetResting{0, true},
          command::SetResting{0, false},
          command::SetMostWork{0, 1e9},
          command::TryAgain{0},
          command::SetWind{wind},
          command::SetEffects{{GravityEffect{}, PaperWindEffect{}, PlateBendingEffect{}}},
          command::SetMaterial{0, material},
          command::AddBall{ball},
          command::SetBallFriction{1, 0.4},
          command::MoveBall{1, Vec3(0.5, 1, 0)},
          command::ThrowBall{1, Vec3(0, 1, 0)},
          command::GrabCloth{0, Vec2(0.5, 0.5), Vec3(0, 1, 0), 30},
          command::GrabCloth{0, Vec2(0.2, 0.5), std::nullopt, 30},
          command::MoveGrab{1, Vec3(0, 1.2, 0)},
          command::Pin{0, Vec2(0.3, 0.3)},
          command::Unpin{0, Vec2(0.3, 0.3)},
          command::SetIntegrator{XpbdDescription{}},
          command::Release{1},
          command::RemoveBall{2},
          command::SetIntegrator{Bdf2Description{}}};
}

Recorded record() {
  const scene::Scene scene = trampoline();
  Simulation<float> simulation(scene.simulation);
  Recorded recorded;
  Recorder recorder(scene, {{"weft", "test"}}, [&](const std::string& bytes) { recorded.text += bytes; });
  const auto commands = all_commands(simulation);
  for (std::size_t step = 0; step < 200; ++step) {
    if (step % 6 == 3 && step / 6 < commands.size()) {
      const command::Command& command = commands[step / 6];
      recorder.add(command);
      std::visit([&](const auto& each) { each.carry_out(simulation); }, command);
    }
    if (step == 160) {
      recorder.add(command::Reset{});
      simulation.reset();
    }
    simulation.step();
    recorder.stepped(simulation);
    recorded.hashes.push_back(state_hash(simulation));
    if (step == 99) recorder.add_state(simulation);
    if (step % 7 == 0) recorder.flush();
  }
  recorder.add_service("all is well");
  recorder.flush();
  return recorded;
}

TEST(Replay, MakesEveryStepAgain) {
  const Recorded recorded = record();
  const Recording recording = Recording::of_text(recorded.text);
  EXPECT_EQ(recording.steps(), 200u);
  EXPECT_EQ(recording.commands(), 23u);
  EXPECT_EQ(recording.damage(), "");
  EXPECT_EQ(recording.head().at("weft"), "test");
  Replay replay(recording);
  for (std::size_t step = 0; step < 200; ++step) {
    ASSERT_TRUE(replay.step());
    ASSERT_EQ(replay.steps(), step + 1);
    const bool commanded = step % 6 == 2 || step == 159;  // after it, which is done already
    if (!commanded) {
      ASSERT_EQ(state_hash(replay.simulation()), recorded.hashes[step]) << step;
    }
  }
  EXPECT_FALSE(replay.step());
  EXPECT_EQ(replay.hashes(), 3u);  // after 60, 120 and 180 steps
  EXPECT_FALSE(replay.divergence());
  EXPECT_EQ(replay.service(), "all is well");
}

TEST(Replay, GoesToAnyTimeThereAndBack) {
  const Recorded recorded = record();
  const Recording recording = Recording::of_text(recorded.text);
  Replay replay(recording);
  for (const std::size_t to : {150u, 120u, 101u, 40u, 100u, 199u, 1u, 200u}) {
    replay.seek(to);
    EXPECT_EQ(replay.steps(), to);
    EXPECT_EQ(state_hash(replay.simulation()), recorded.hashes[to - 1]) << to;
  }
  replay.seek(1000);
  EXPECT_EQ(replay.steps(), 200u);
  EXPECT_FALSE(replay.divergence());
}

TEST(Replay, TellsWhereAnotherStateIsReached) {
  const scene::Scene scene = trampoline();
  Simulation<float> simulation(scene.simulation);
  std::string text;
  Recorder recorder(scene, {}, [&](const std::string& bytes) { text += bytes; });
  for (int step = 0; step < 180; ++step) {
    if (step == 70) simulation.request_level(0, 3);  // which nobody wrote down
    simulation.step();
    recorder.stepped(simulation);
  }
  recorder.flush();
  const Recording recording = Recording::of_text(text);
  Replay replay(recording);
  while (replay.step()) {
  }
  ASSERT_TRUE(replay.divergence());
  EXPECT_EQ(replay.divergence()->step, 120u);
  EXPECT_NE(replay.divergence()->recorded, replay.divergence()->found);
  EXPECT_EQ(replay.hashes(), 1u);
}

TEST(Replay, OfACutFileGoesAsFarAsItIsWhole) {
  const Recorded recorded = record();
  std::uint64_t most = 0;
  for (std::size_t eighth = 1; eighth <= 8; ++eighth) {
    const std::size_t size = recorded.text.size() * eighth / 8 - 1;
    const Recording recording = Recording::of_text(recorded.text.substr(0, size));
    EXPECT_NE(recording.damage(), "");
    Replay replay(recording);
    while (replay.step()) {
    }
    EXPECT_EQ(replay.steps(), recording.steps());
    EXPECT_GE(recording.steps(), most);
    EXPECT_FALSE(replay.divergence());
    most = recording.steps();
  }
  EXPECT_EQ(most, 200u);  // but for what was told last
}

TEST(Recording, OfSomethingElseIsRefused) {
  EXPECT_THROW(Recording::of_text(""), std::invalid_argument);
  EXPECT_THROW(Recording::of_text(std::string(kMark)), std::invalid_argument);
  std::string text(kMark);
  append_chunk(text, {ChunkKind::scene, "[1]"});
  EXPECT_THROW(Recording::of_text(text), std::invalid_argument);
  EXPECT_THROW(Recording::of_file("/nowhere/at-all"), std::runtime_error);
}

// Right by its checksum, but by no build that this one knows.
TEST(Recording, CommandsThatAreNoneEndIt) {
  Recorded recorded = record();
  const std::size_t whole = Recording::of_text(recorded.text).events().size();
  append_chunk(recorded.text, {ChunkKind::commands, std::string("\x01\0\0\0\0\0\0\0\xff\xff\xff\xff", 12)});
  const Recording recording = Recording::of_text(recorded.text);
  EXPECT_NE(recording.damage(), "");
  EXPECT_EQ(recording.events().size(), whole);
}

}  // namespace
}  // namespace weft::record
