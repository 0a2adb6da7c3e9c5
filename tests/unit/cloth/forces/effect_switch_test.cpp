// Effects taken away and brought back between two steps: what is off is not there.
#include <gtest/gtest.h>

#include <memory>

#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"

namespace weft {
namespace {

const IntegratorDescription kMethods[] = {Bdf2Description{}, BackwardEulerDescription{}, XpbdDescription{},
                                          SymplecticEulerDescription{}};

/// A sheet hung by two corners in eddying wind, with every effect and a ball that falls beside it.
SimulationDescription windy_sheet(const IntegratorDescription& integrator = Bdf2Description{}) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  cloth.material.damping = 0.5;
  cloth.material.rigidity = Rigidity{1e-4, 1e-4, 1e-4};
  cloth.material.limit.warp = cloth.material.limit.weft = cloth.material.limit.shear = 1e-3;  // soon reached
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{},       DampingEffect{},      PaperWindEffect{},  AerodynamicsEffect{},
                   StrainDampingEffect{}, PlateBendingEffect{}, StrainLimitEffect{}};
  scene.wind = {{0, 0, -1}, 3};
  scene.wind.turbulence = {0.3, 0.5};
  BallDescription ball;
  ball.position = {3, 0, 0};
  ball.motion = BallDescription::Motion::dynamic;
  scene.balls = {ball};
  scene.integrator = integrator;
  return scene;
}

std::vector<EffectDescription> without(std::vector<EffectDescription> effects, std::size_t index) {
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(index));
  return effects;
}

template <class Real>
std::uint64_t hash_after(Simulation<Real>& simulation, int steps) {
  for (int step = 0; step < steps; ++step) simulation.step();
  return state_hash(simulation);
}

TEST(EffectSwitchSlow, WhatIsOffIsAsIfTheSceneDidNotListIt) {
  for (const IntegratorDescription& integrator : kMethods) {
    const SimulationDescription all = windy_sheet(integrator);
    Simulation<float> untouched(all);
    const std::uint64_t with_all = hash_after(untouched, 8);
    for (std::size_t i = 0; i < all.effects.size(); ++i) {
      SCOPED_TRACE(std::string(name_of(all.effects[i])) + ", method " + std::to_string(integrator.index()));
      SimulationDescription less = all;
      less.effects = without(all.effects, i);
      Simulation<float> listed(less), switched(all);
      switched.set_effects(less.effects);
      const std::uint64_t without_it = hash_after(listed, 8);
      EXPECT_EQ(hash_after(switched, 8), without_it);
      EXPECT_NE(without_it, with_all);
      // Brought back, it is as if it had always been there: only the integrator begins anew.
      Simulation<float> both(all);
      both.set_effects(less.effects);
      both.set_effects(all.effects);
      EXPECT_EQ(hash_after(both, 8), with_all);
    }
  }
}

TEST(EffectSwitchSlow, InMotionIsAnotherCompositionOfTheSameState) {
  // From the 8th step on: a scene that never listed it and has the state of that moment goes the same way.
  for (const IntegratorDescription& integrator : kMethods) {
    SimulationDescription all = windy_sheet(integrator);
    all.wind.turbulence = {};  // eddies go by the scene's time
    all.balls.clear();
    for (std::size_t i = 0; i < all.effects.size(); ++i) {
      SCOPED_TRACE(std::string(name_of(all.effects[i])) + ", method " + std::to_string(integrator.index()));
      Simulation<float> switched(all);
      hash_after(switched, 8);
      SimulationDescription less = all;
      less.effects = without(all.effects, i);
      Simulation<float> other(less);
      other.cloths()[0].particles() = switched.cloths()[0].particles();
      other.set_integrator(integrator);
      switched.set_effects(less.effects);
      for (int step = 0; step < 8; ++step) {
        switched.step();
        other.step();
      }
      const Particles<float>& a = switched.cloths()[0].particles();
      const Particles<float>& b = other.cloths()[0].particles();
      test::each_node(a.grid(), [&](int r, int c) {
        ASSERT_EQ(test::get(a.position, r, c), test::get(b.position, r, c)) << r << ", " << c;
      });
    }
  }
}

TEST(EffectSwitch, WithoutGravityABallFliesStraightOn) {
  Simulation<float> simulation(windy_sheet());
  hash_after(simulation, 30);
  const double speed = simulation.colliders().balls()[0].velocity.y();
  EXPECT_NEAR(speed, -9.81 / 2, 1e-9);
  simulation.set_effects(without(windy_sheet().effects, 0));
  const double before = simulation.colliders().balls()[0].position.y();
  hash_after(simulation, 60);
  EXPECT_NEAR(simulation.colliders().balls()[0].position.y() - before, speed, 1e-9);
  EXPECT_EQ(simulation.gravity(), Vec3(0, 0, 0));
}

TEST(EffectSwitch, WakesAClothThatSleeps) {
  SimulationDescription scene = windy_sheet();
  scene.cloths[0].pins = {{0, 1, 0, 0}};
  scene.wind = {};
  scene.effects = {GravityEffect{}, DampingEffect{}, PlateBendingEffect{}};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 2400 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  ASSERT_NE(simulation.cloths()[0].plate(), nullptr);
  const double lowest = simulation.centre(0).y();
  simulation.set_effects({DampingEffect{}});
  EXPECT_FALSE(simulation.cloths()[0].asleep());
  EXPECT_EQ(simulation.cloths()[0].plate(), nullptr);
  hash_after(simulation, 60);
  EXPECT_GT(simulation.centre(0).y(), lowest);  // the springs draw together what gravity had stretched
}

TEST(EffectSwitch, LeavesAHandAndWhatWasAddedAlone) {
  Simulation<float> simulation(windy_sheet());
  const GrabId grab = simulation.grab(0, {0.5, 1}, Vec3(0, 0, 1), 100);
  simulation.set_effects({});
  simulation.set_effects({GravityEffect{}});
  EXPECT_EQ(simulation.cloths()[0].grabs().size(), 1u);
  hash_after(simulation, 60);
  const Vec3 held =
      Grabs<float>::place(simulation.cloths()[0].particles(), windy_sheet().cloths[0], {0.5, 1});
  EXPECT_GT(held.z(), 0.3);
  EXPECT_TRUE(simulation.release(grab));
}

TEST(EffectSwitch, ClothContactComesAndGoes) {
  SimulationDescription scene = windy_sheet();
  scene.effects.push_back(ClothContactEffect{});
  Simulation<float> simulation(scene), listed(windy_sheet());
  simulation.step();
  ASSERT_NE(simulation.layers(), nullptr);
  simulation.set_effects(windy_sheet().effects);
  EXPECT_EQ(simulation.layers(), nullptr);
  hash_after(simulation, 8);
  simulation.set_effects(scene.effects);
  hash_after(simulation, 8);
  EXPECT_NE(simulation.layers(), nullptr);
  // Nothing of the hung sheet comes near another part of it: it hangs as without.
  simulation.reset();
  EXPECT_EQ(hash_after(simulation, 8), hash_after(listed, 8));
}

TEST(EffectSwitch, EndsWithAReset) {
  Simulation<float> simulation(windy_sheet()), fresh(windy_sheet());
  simulation.set_effects({});
  hash_after(simulation, 10);
  simulation.reset();
  EXPECT_EQ(hash_after(simulation, 30), hash_after(fresh, 30));
}

}  // namespace
}  // namespace weft
