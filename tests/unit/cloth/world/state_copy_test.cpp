// A simulation goes on from another one's state to the bit, whatever has happened there.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "busy_scene.h"
#include "cloth/core/parallel.h"
#include "cloth/world/state_hash.h"
#include "faults.h"
#include "folding_scenes.h"

namespace weft {
namespace {

using test::ball_at;
using test::busy_scene;
using test::flying;
using test::flying_ball;
using test::ground;
using test::hung_scene;
using test::run;

constexpr int kStepsAfter = 10;

/// A scene, what is done in it before a step (counted from 0), and after how many steps it is copied.
struct CopyCase {
  std::string name;
  SimulationDescription scene;
  int steps;
  std::function<void(Simulation<float>&, int)> act = [](Simulation<float>&, int) {};
  std::function<void(Simulation<float>&)> wish = [](Simulation<float>&) {};  ///< said before it is copied
};

std::ostream& operator<<(std::ostream& out, const CopyCase& each) { return out << each.name; }

SimulationDescription with(SimulationDescription scene, const IntegratorDescription& integrator) {
  scene.integrator = integrator;
  return scene;
}

SimulationDescription with_effects(SimulationDescription scene,
                                   const std::vector<EffectDescription>& effects) {
  scene.effects.insert(scene.effects.end(), effects.begin(), effects.end());
  return scene;
}

SimulationDescription windy_scene() {
  SimulationDescription scene = with_effects(hung_scene(), {AerodynamicsEffect{}});
  scene.wind = {{0, 0, -1}, 3.0, {0.3, 1.0}, {0.2, 0.3}};
  return scene;
}

/// One pin goes along a path, the other with an obstacle that turns.
SimulationDescription carried_scene(const IntegratorDescription& integrator) {
  SimulationDescription scene = with(hung_scene(), integrator);
  scene.cloths[0].pins[0].path = {{0, {0, 0, 0}}, {1, {0.5, 0, 0.5}}};
  ObstacleDescription hand = test::standing(BoxDescription{{0.1, 0.1, 0.1}}, {2, 1, 0});
  for (int quarter = 0; quarter <= 4; ++quarter) {
    hand.path.push_back(test::turned(0.25 * quarter, {2, 1 + 0.1 * quarter, 0}, quarter / 4.0));
  }
  scene.obstacles = {hand};
  scene.cloths[0].pins[1].obstacle = 0;
  return scene;
}

/// A sheet lies over a ball that yields and a body that tumbles, on a floor.
SimulationDescription tumbling_scene(const IntegratorDescription& integrator) {
  SimulationDescription scene = test::cloth_scene({1, 1}, 4, integrator);
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.cloths[0].position = {0, 0.6, 0};
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths[0].perturbation = 0.001;
  scene.balls = {flying_ball({0.2, 0.4, 0}, 0.15, {1, 0, 0}, 0.5), ball_at({2, 1, 0}, 0.1)};
  scene.obstacles = {ground(0.5), flying(BoxDescription{{0.3, 0.2, 0.2}}, {-0.2, 0.4, 0.1}, {0, 0, 1}, 0.5)};
  scene.obstacles[1].body->spin = {2, 5, 1};
  return scene;
}

/// A strip whose load is just beyond its strength: it tears in one step after another.
SimulationDescription tearing_scene(const IntegratorDescription& integrator, bool plate) {
  SimulationDescription scene = with(hung_scene(), integrator);
  scene.cloths[0].pins = {{0, 1, 0, 0}, {0.4, 0.6, 1, 1}};
  scene.cloths[0].pins[1].path = {{0, {0, 0, 0}}, {1, {0, -1, 0.3}}};
  scene.effects.push_back(TearingEffect{200, 200});
  scene.effects.push_back(StrainDampingEffect{0.01});
  scene.effects.push_back(AerodynamicsEffect{});  // which torn faces do not feel
  if (plate) scene.effects.push_back(PlateBendingEffect{});
  return scene;
}

SimulationDescription bag_scene(const IntegratorDescription& integrator, double fill_time) {
  SimulationDescription scene = test::cloth_scene({2, 1}, 4, integrator);
  scene.effects = {GravityEffect{}, DampingEffect{}, InflationEffect{200, 0.1, fill_time}};
  ClothDescription& bag = scene.cloths[0];
  bag.base_cells = {2, 1};
  bag.sewn = true;
  bag.position = {0, 0.3, 0};
  bag.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.obstacles = {ground(0.5)};
  return scene;
}

/// Nothing moves it: after a second it sleeps.
SimulationDescription sleeping_scene() {
  SimulationDescription scene = hung_scene();
  scene.effects = {DampingEffect{}};
  scene.cloths[0].perturbation = 0;
  scene.sleep_speed = 1e-4;
  return scene;
}

void hold(Simulation<float>& s, int step) {
  if (step == 3) s.grab(0, {0.5, 1}, Vec3(0, -1, 0.5), 50);
  if (step == 6) s.grab(0, {0.2, 0.8}, {}, 5);
  if (step == 8) s.move_grab(1, {0.3, -0.8, 0.6});
  if (step == 21) s.grab(0, {0.7, 0.6}, Vec3(0, 1, 1), 20);  // the third
  if (step == 22) s.move_grab(2, {0.3, 0.4, 0.6});
  if (step == 24) s.release(1);
}

void command_colliders(Simulation<float>& s, int step) {
  if (step == 4) s.grab_obstacle(1, {0.1, 0, 0}, Vec3(0, 1, 0), 30);
  if (step == 5) s.remove_ball(s.add_ball(ball_at({3, 3, 3}, 0.1)));  // its number is used up
  if (step == 19) s.move_ball(2, {0.5, 0.3, 0});
  if (step == 22) s.move_grab(1, {0.5, 1, 0.2});
  if (step == 24) s.add_ball(flying_ball({0, 1.2, 0}, 0.1));
}

std::vector<CopyCase> copy_cases() {
  std::vector<CopyCase> cases;
  const auto add = [&](std::string name, SimulationDescription scene, int steps,
                       std::function<void(Simulation<float>&, int)> act = {}) {
    cases.push_back({std::move(name), std::move(scene), steps});
    if (act) cases.back().act = std::move(act);
  };
  for (const IntegratorDescription& integrator : test::default_integrators()) {
    const std::string by = std::string("_") + test::name_of(integrator);
    add("busy" + by, with(busy_scene(), integrator), 14);
    add("damped_limited_plate" + by,
        with_effects(with(busy_scene(), integrator),
                     {StrainDampingEffect{0.003}, StrainLimitEffect{}, PlateBendingEffect{}}),
        14);
    add("carried" + by, carried_scene(integrator), 20);
    add("tumbling" + by, tumbling_scene(integrator), 20, command_colliders);
    add("tearing" + by, tearing_scene(integrator, false), 20);
    add("gas" + by, bag_scene(integrator, 1), 20);
    add("heap" + by, test::dropped_on_edge(4, integrator), 30);
    add("caught" + by, test::caught(4, integrator), 20);
    add("on_another" + by, test::on_a_slope(20, 0.3, integrator), 20);
  }
  add("torn_plate", tearing_scene(Bdf2Description{}, true), 20);
  add("gas_at_once", bag_scene(XpbdDescription{}, 0), 3);
  add("gas_merged", bag_scene(Bdf2Description{}, 1), 20, [](Simulation<float>& s, int step) {
    if (step == 12) s.request_level(0, 3);
  });
  cases.back().scene.cloths[0].min_level = 3;
  add("put_through_itself", test::poked_by_its_corner(4, Bdf2Description{}), 5);
  add("tangled", test::stuck_in(4, Bdf2Description{}), 5);
  add("pumped", with_effects(hung_scene(), {InflationEffect{}}), 20);
  add("wrung", test::wrung(4, Bdf2Description{}), 60);
  add("wind_changes", windy_scene(), 20, [](Simulation<float>& s, int step) {
    if (step == 7 || step == 25) {
      Wind wind = s.wind();
      wind.speed += 2;
      s.set_wind(wind);
    }
  });
  add("held", hung_scene(), 20, hold);
  add("held_and_let_go", hung_scene(), 25, [](Simulation<float>& s, int step) {
    if (step == 3) s.grab(0, {0.5, 1}, Vec3(0, -1, 0.5), 50);
    if (step == 20) s.release(1);
  });
  add("pinned_anew", hung_scene(), 20, [](Simulation<float>& s, int step) {
    if (step == 5) s.unpin(0, {0, 0});
    if (step == 9) s.pin(0, {0.3, 0.7});
    if (step == 24) s.unpin(0, {1, 0});
  });
  add("split", busy_scene(), 20, [](Simulation<float>& s, int step) {
    if (step == 10) s.request_level(0, 5);
  });
  add("merged_and_split", with(busy_scene(), SymplecticEulerDescription{}), 20,
      [](Simulation<float>& s, int step) {
        if (step == 10) s.request_level(0, 3);
        if (step == 19) s.request_level(0, 4);
      });
  // The copy is made between the wish and the step that fulfils it.
  add("split_is_wished", busy_scene(), 20);
  cases.back().wish = [](Simulation<float>& s) { s.request_level(0, 5); };
  add("torn_and_split", tearing_scene(Bdf2Description{}, true), 20, [](Simulation<float>& s, int step) {
    if (step == 15) s.request_level(0, 5);
  });
  add("another_integrator", busy_scene(), 20, [](Simulation<float>& s, int step) {
    if (step == 12) s.set_integrator(XpbdDescription{});
  });
  add("soft_for_its_digits", hung_scene(), 20);
  cases.back().scene.cloths[0].material.structural = 1e9;
  add("about_to_sleep", sleeping_scene(), 40);
  add("asleep_until_the_wind_changes", with_effects(sleeping_scene(), {AerodynamicsEffect{}}), 80,
      [](Simulation<float>& s, int step) {
        if (step == 85) s.set_wind({{0, 0, -1}, 1.0});
      });
  add("resting", hung_scene(), 20, [](Simulation<float>& s, int step) {
    if (step == 10) s.set_resting(0, true);
    if (step == 25) s.set_resting(0, false);
  });
  add("balls_asleep", sleeping_scene(), 90, [](Simulation<float>& s, int step) {
    if (step == 95) s.move_ball(2, {0.3, -2.8, 0});
  });
  cases.back().scene.effects = {GravityEffect{}, DampingEffect{}};
  cases.back().scene.balls = {flying_ball({0, -2.7995, 0}, 0.2), ball_at({2, -2.8, 0}, 0.1)};
  cases.back().scene.obstacles = {ground(0.5)};
  cases.back().scene.obstacles[0].position = {0, -3, 0};
  return cases;
}

/// The copy is made into a simulation that is at its start.
template <class Real>
Simulation<Real> copy_of(const Simulation<Real>& other) {
  Simulation<Real> copy(other.description());
  copy.take_state(other);
  return copy;
}

/// What is told of the last step and of all before, which is not in the hash.
template <class Real>
void expect_same_reports(const Simulation<Real>& a, const Simulation<Real>& b) {
  EXPECT_EQ(a.guard_events().size(), b.guard_events().size());
  for (std::size_t i = 0; i < a.cloths().size(); ++i) {
    EXPECT_EQ(a.last_advance(i).substeps, b.last_advance(i).substeps);
    EXPECT_EQ(a.last_advance(i).nodes_in_contact, b.last_advance(i).nodes_in_contact);
    const ContactCounters one = a.cloths()[i].contact_counters(), other = b.cloths()[i].contact_counters();
    EXPECT_EQ(one.nodes_tested, other.nodes_tested);
    EXPECT_EQ(one.nodes_in_contact, other.nodes_in_contact);
    EXPECT_EQ(a.cloths()[i].asleep(), b.cloths()[i].asleep());
  }
}

class StateCopies : public testing::TestWithParam<CopyCase> {};

TEST_P(StateCopies, GoesOnAsItsOriginal) {
  const CopyCase& each = GetParam();
  Simulation<float> original(each.scene);
  const auto step = [&](Simulation<float>& simulation, int number) {
    each.act(simulation, number);
    simulation.step();
  };
  for (int i = 0; i < each.steps; ++i) step(original, i);
  each.wish(original);
  Simulation<float> copy = copy_of(original);
  EXPECT_EQ(state_hash(copy), state_hash(original));
  expect_same_reports(copy, original);
  for (int i = each.steps; i < each.steps + kStepsAfter; ++i) {
    step(original, i);
    const ThreadLimit alone(1);  // the original has as many as there are
    step(copy, i);
    ASSERT_EQ(state_hash(copy), state_hash(original)) << "after step " << i;
    expect_same_reports(copy, original);
  }
}

// What it has gone through itself is no part of it any more: where it was at another level, torn, held,
// filled, and asleep or not.
TEST_P(StateCopies, GoesOnAsItsOriginalWhateverItWasBeforeSlow) {
  const CopyCase& each = GetParam();
  Simulation<float> original(each.scene), later(each.scene);
  const auto step = [&](Simulation<float>& simulation, int number) {
    each.act(simulation, number);
    simulation.step();
  };
  for (int i = 0; i < each.steps / 2; ++i) step(original, i);
  for (int i = 0; i < each.steps + kStepsAfter; ++i) step(later, i);
  later.take_state(original);
  for (int i = each.steps / 2; i < each.steps / 2 + kStepsAfter; ++i) {
    step(original, i);
    step(later, i);
    ASSERT_EQ(state_hash(later), state_hash(original)) << "after step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StateCopies, testing::ValuesIn(copy_cases()),
                         [](const auto& each) { return each.param.name; });

// In double precision as well, and with a guard that has the cloth stepped in a safer way for a while: the
// fault itself is an effect of the original's own, and over when the copy is made.
TEST(StateCopy, KeepsWhatTheGuardDoes) {
  Simulation<double> original(with(busy_scene(), SymplecticEulerDescription{}));
  bool spoilt = false;
  test::add_fault<double>(original.cloths()[0], [&spoilt](double time, VectorField<double>& force) {
    if (time > 0.1 && !std::exchange(spoilt, true)) {
      test::set(force, 3, 3, Vec3::Constant(test::kNaN<double>));
    }
  });
  for (int i = 0; i < 10 && original.cloths()[0].steps_as_asked(); ++i) original.step();
  ASSERT_FALSE(original.guard_events().empty());
  Simulation<double> copy = copy_of(original);
  expect_same_reports(copy, original);
  EXPECT_EQ(copy.profile().total, original.profile().total);
  EXPECT_FALSE(copy.cloths()[0].steps_as_asked());
  for (int i = 0; i < StepGuard<double>::kHold + 5; ++i) {
    original.step();
    copy.step();
    ASSERT_EQ(state_hash(copy), state_hash(original)) << "after step " << i;
  }
  EXPECT_TRUE(copy.cloths()[0].steps_as_asked());
}

/// Something of all effects that leave a state of their own, by a method that remembers nothing.
std::vector<SimulationDescription> owning_scenes() {
  const SymplecticEulerDescription euler;
  return {bag_scene(euler, 1), tearing_scene(euler, true), test::caught(4, euler),
          with_effects(with(busy_scene(), euler), {InflationEffect{}, StrainLimitEffect{}})};
}

// What is left of an effect that the copy has not is what set_effects leaves of it.
TEST(StateCopySlow, WithoutAnEffectIsAsIfThatWereSwitchedOff) {
  for (const SimulationDescription& scene : owning_scenes()) {
    Simulation<float> original(scene);
    run(original, 20);
    for (std::size_t i = 0; i < scene.effects.size(); ++i) {
      SCOPED_TRACE(name_of(scene.effects[i]));
      SimulationDescription less = scene;
      less.effects.erase(less.effects.begin() + static_cast<std::ptrdiff_t>(i));
      Simulation<float> without(less), switched = copy_of(original);
      without.take_state(original);
      EXPECT_EQ(state_hash(without), state_hash(original));
      EXPECT_EQ(without.cloths()[0].gas() != nullptr,
                original.cloths()[0].gas() != nullptr &&
                    !std::holds_alternative<InflationEffect>(scene.effects[i]));
      switched.set_effects(less.effects);
      run(without, 5);
      run(switched, 5);
      EXPECT_EQ(state_hash(without), state_hash(switched));

      // And back: what only the copy has begins as if it were switched on.
      Simulation<float> again(scene);
      again.take_state(without);
      switched.set_effects(scene.effects);
      run(again, 5);
      run(switched, 5);
      EXPECT_EQ(state_hash(again), state_hash(switched));
    }
  }
}

TEST(StateCopy, OfClothsLeavesCollidersAndLetsTheirPinsStand) {
  Simulation<float> original(carried_scene(Bdf2Description{}));
  run(original, 20);
  SimulationDescription scene = carried_scene(Bdf2Description{});
  scene.obstacles.clear();
  scene.cloths[0].pins[1].obstacle.reset();
  Simulation<float> bare(scene);
  bare.take_cloths(original);
  EXPECT_EQ(state_hash(bare), state_hash(original));  // which is not of what goes where it is told
  const Vec3 pinned = original.cloths()[0].particles().position_at(0, 16);
  bare.step();
  EXPECT_EQ(bare.cloths()[0].particles().position_at(0, 16), pinned);
  original.step();
  EXPECT_GT((original.cloths()[0].particles().position_at(0, 16) - pinned).norm(), 1e-3);
  EXPECT_TRUE(bare.colliders().solids().empty());
}

TEST(StateCopy, IsOfTheSameSceneOnly) {
  const SimulationDescription scene = tumbling_scene(Bdf2Description{});
  const std::vector<std::pair<std::string, std::function<void(SimulationDescription&)>>> changes{
      {"time steps differ", [](SimulationDescription& s) { s.time_step = 0.01; }},
      {"numbers of cloths differ", [](SimulationDescription& s) { s.cloths.push_back(s.cloths[0]); }},
      {"base cells of cloth 0 differ",
       [](SimulationDescription& s) {
         s.cloths[0].base_cells = {2, 1};
       }},
      {"levels of cloth 0 differ", [](SimulationDescription& s) { s.cloths[0].max_level = 5; }},
      {"sheets of cloth 0 differ",
       [](SimulationDescription& s) {
         s.cloths[0].size = {1, 1.5};
       }},
      {"masses of cloth 0 differ", [](SimulationDescription& s) { s.cloths[0].material.density = 1; }},
      {"numbers of obstacles differ", [](SimulationDescription& s) { s.obstacles.pop_back(); }},
      {"kinds of obstacle 1 differ", [](SimulationDescription& s) { s.obstacles[1].body.reset(); }}};
  Simulation<float> original(scene);
  run(original, 2);
  for (const auto& [what, change] : changes) {
    SimulationDescription changed = scene;
    change(changed);
    Simulation<float> other(changed);
    const std::uint64_t before = state_hash(other);
    try {
      other.take_state(original);
      ADD_FAILURE() << "taken, though " << what;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "the states of different scenes are no copies of each other: " + what);
    }
    EXPECT_EQ(state_hash(other), before);
  }
}

}  // namespace
}  // namespace weft
