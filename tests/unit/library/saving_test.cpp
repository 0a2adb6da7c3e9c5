// The library's states: saved, and gone on from.
#include "fixtures.h"

namespace weft {
namespace {

TEST(WorldState, GoesOnToTheBit) {
  World world = World::parse(kFalling);
  world.add_ball({.position = {0, -1, 0}, .mass = 1});
  world.set_effect("damping", false);
  world.set_parameter("gravity", "acceleration", {0, -5, 0});
  world.look_from({0, 0, 5});
  world.step(10);
  const std::string state = world.save();
  World other = World::parse(kFalling);
  other.restore(state);
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_EQ(other.effects(), world.effects());
  for (World* each : {&world, &other}) {
    // What was off, and tuned, is known to whoever changes it next.
    each->set_effect("damping", true);
    each->look_from({0, 0, 9.9});
    each->step(20);
  }
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_EQ(other.time(), world.time());
}

TEST(WorldState, OfAnotherSceneOrDamagedIsRefused) {
  World world = World::parse(kFalling);
  world.step(3);
  const std::string state = world.save();
  World flag = World::load("flag");
  const std::uint64_t before = flag.hash();
  EXPECT_EQ(error_of([&] { flag.restore(state); }), "the state is of another scene");
  EXPECT_EQ(flag.hash(), before);
  EXPECT_EQ(error_of([&] { world.restore(""); }), "the state ends too early");
  EXPECT_EQ(error_of([&] { world.restore(state.substr(0, state.size() / 2)); }),
            "the state was cut off or changed");
  for (std::size_t at = 16; at < state.size(); at += state.size() / 7) {
    std::string changed = state;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_EQ(error_of([&] { world.restore(changed); }), "the state was cut off or changed") << at;
  }
  world.restore(state);
}

}  // namespace
}  // namespace weft
