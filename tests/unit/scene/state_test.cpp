/// A simulation's state written down and read again (world/state.h): every preset by every method, with
/// commands and changes of level on the way, goes on as if nothing had happened.
#include "cloth/world/state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cloth/core/archive.h"
#include "cloth/world/state_hash.h"
#include "scene/scene.h"

namespace weft {
namespace {

SimulationDescription preset(const std::string& name) {
  SimulationDescription description = std::get<scene::Scene>(scene::load(name)).simulation;
  for (ClothDescription& cloth : description.cloths) cloth.initial_level = std::max(4, cloth.min_level);
  return description;
}

/// What viewers do: a command or none, the same for equal draws.
template <class Real>
void command(Simulation<Real>& simulation, std::mt19937& draw) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(draw);
  };
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(draw); };
  const std::size_t cloth = below(simulation.cloths().size());
  const Vec2 at(unit(), unit());
  const Vec3 away(unit() - 0.5, unit() - 0.5, unit() - 0.5);
  switch (below(12)) {
    case 0:
      return simulation.request_level(cloth, 3 + static_cast<int>(below(3)));
    case 1: {
      BallDescription ball;
      ball.position = simulation.centre(cloth) + away;
      ball.velocity = 2 * away;
      ball.radius = 0.1;
      ball.motion = BallDescription::Motion::dynamic;
      simulation.add_ball(ball);
      return;
    }
    case 2:
      simulation.grab(cloth, at, simulation.centre(cloth) + away, 20);
      return;
    case 3:
      simulation.release(static_cast<GrabId>(1 + below(4)));
      return;
    case 4:
      return simulation.pin(cloth, at);
    case 5:
      simulation.unpin(cloth, at);
      return;
    case 6: {
      Wind wind = simulation.wind();
      wind.speed = 4 * unit();
      return simulation.set_wind(wind);
    }
    case 7:
      simulation.move_ball(static_cast<BallId>(1 + below(3)), simulation.centre(cloth) + away);
      return;
    case 8:
      if (!simulation.colliders().obstacles().empty()) simulation.throw_obstacle(0, away, away);
      return;
    case 9:
      return simulation.set_resting(cloth, below(2) == 0);
    case 10: {
      Material material = simulation.cloths()[cloth].description().material;
      material.structural = {material.structural.warp * (0.5 + unit()),
                             material.structural.weft * (0.5 + unit())};
      return simulation.set_material(cloth, material);
    }
    default:
      return;
  }
}

template <class Real>
void steps(Simulation<Real>& simulation, std::mt19937& draw, int count) {
  for (int step = 0; step < count; ++step) {
    if (step % 5 == 0) command(simulation, draw);
    simulation.step();
  }
}

class StateOfPreset : public testing::TestWithParam<const char*> {};

TEST_P(StateOfPreset, GoesOnToTheBit) {
  const std::vector<IntegratorDescription> methods{Bdf2Description{}, BackwardEulerDescription{},
                                                   XpbdDescription{}, SymplecticEulerDescription{}};
  unsigned seed = 1;
  for (const IntegratorDescription& method : methods) {
    SimulationDescription description = preset(GetParam());
    description.integrator = method;
    SCOPED_TRACE(method.index());
    std::mt19937 draw(seed++);
    // Torn paper among balls takes ten thousand explicit substeps a step.
    const int share = std::holds_alternative<SymplecticEulerDescription>(method) ? 6 : 1;
    Simulation<float> one(description);
    steps(one, draw, 48 / share);
    const std::string state = save_state(one);
    Simulation<float> other(description);
    std::mt19937 elsewhere(99);
    steps(other, elsewhere, 12 / share);  // whatever has happened in it
    load_state(other, state);
    ASSERT_EQ(state_hash(other), state_hash(one));
    ASSERT_TRUE(save_state(other) == state);
    std::mt19937 same = draw;
    for (int step = 0; step < 24 / share; ++step) {
      for (const auto& [simulation, random] : {std::pair{&one, &draw}, {&other, &same}}) {
        if (step % 6 == 3) command(*simulation, *random);
        simulation->step();
      }
      ASSERT_EQ(state_hash(other), state_hash(one)) << "after " << step + 1 << " steps";
      ASSERT_TRUE(save_state(other) == save_state(one)) << "after " << step + 1 << " steps";
    }
  }
}

std::vector<const char*> names() {
  std::vector<const char*> all;
  for (const scene::Preset& each : scene::presets()) all.push_back(each.name.data());
  return all;
}
INSTANTIATE_TEST_SUITE_P(Slow, StateOfPreset, testing::ValuesIn(names()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(State, HasTheEffectsThatAreOn) {
  SimulationDescription description = preset("flag");
  Simulation<float> one(description);
  one.set_effects({GravityEffect{Vec3(0, -1.6, 0)}});
  one.set_integrator(XpbdDescription{});
  for (int step = 0; step < 10; ++step) one.step();
  Simulation<float> other(description);
  load_state(other, save_state(one));
  EXPECT_EQ(other.gravity(), Vec3(0, -1.6, 0));
  one.step();
  other.step();
  EXPECT_EQ(state_hash(other), state_hash(one));
}

TEST(State, OfASleepingClothSleepsOn) {
  SimulationDescription description = preset("swing");
  description.sleep_speed = 1e9;
  Simulation<float> one(description);
  for (int step = 0; step < 100; ++step) one.step();
  ASSERT_TRUE(one.cloths()[0].asleep());
  Simulation<float> other(description);
  load_state(other, save_state(one));
  EXPECT_TRUE(other.cloths()[0].asleep());
}

TEST(State, ThatEndsTooEarlyOrLateIsRefused) {
  const SimulationDescription description = preset("silk");
  Simulation<float> simulation(description);
  for (int step = 0; step < 20; ++step) simulation.step();
  const std::string state = save_state(simulation);
  for (std::size_t size = 0; size < state.size(); size += 1 + size / 7) {
    Simulation<float> other(description);
    EXPECT_THROW(load_state(other, std::string_view(state).substr(0, size)), BadState) << size;
  }
  EXPECT_THROW(load_state(simulation, state + "x"), BadState);
}

TEST(State, OfAnotherSceneIsRefused) {
  Simulation<float> flag(preset("flag")), silk(preset("silk"));
  EXPECT_THROW(load_state(silk, save_state(flag)), std::exception);
}

}  // namespace
}  // namespace weft
