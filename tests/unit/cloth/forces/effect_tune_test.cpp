// Numbers of effects changed between two steps: the scene goes on from where it is, as if it listed the
// others.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cloth/core/effect_description.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"

namespace weft {
namespace {

const IntegratorDescription kTunedMethods[] = {Bdf2Description{}, BackwardEulerDescription{},
                                               XpbdDescription{}, SymplecticEulerDescription{}};

/// A sheet of 1 m with velocity, pinned by two corners unless it is free.
SimulationDescription tuned_sheet(const IntegratorDescription& integrator, bool free = false) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  cloth.velocity = {0.25, 0, 0.5};
  if (!free) cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.integrator = integrator;
  scene.sleep_speed = 0;
  return scene;
}

template <class Real>
void steps(Simulation<Real>& simulation, int count) {
  for (int step = 0; step < count; ++step) simulation.step();
}

/// Mean of the nodes'.
template <class Real>
Vec3 tuned_velocity(const Simulation<Real>& simulation) {
  const Particles<Real>& particles = simulation.cloths()[0].particles();
  Vec3 sum(0, 0, 0);
  test::each_node(particles.grid(), [&](int r, int c) { sum += test::get(particles.velocity, r, c); });
  return sum / particles.grid().nodes();
}

void expect_finite(const Simulation<float>& simulation) {
  const Particles<float>& particles = simulation.cloths()[0].particles();
  test::each_node(particles.grid(), [&](int r, int c) {
    ASSERT_TRUE(test::get(particles.position, r, c).allFinite());
    ASSERT_TRUE(test::get(particles.velocity, r, c).allFinite());
  });
}

/// Effects with numbers, as listed and otherwise; all act on the sheet above.
struct Tuning {
  EffectDescription listed, other;
};
const Tuning kTunings[] = {
    {GravityEffect{}, GravityEffect{{0, -1.62, 0}}},       {PaperWindEffect{}, PaperWindEffect{0.5}},
    {AerodynamicsEffect{}, AerodynamicsEffect{1, 0.5, 2}}, {StrainDampingEffect{}, StrainDampingEffect{0.01}},
    {InflationEffect{10}, InflationEffect{-20}},           {TearingEffect{1e6, 1e6}, TearingEffect{0.5, 1e6}},
};

SimulationDescription with_all(const IntegratorDescription& integrator) {
  SimulationDescription scene = tuned_sheet(integrator);
  scene.wind = {{0, 0, -1}, 3};
  for (const Tuning& tuning : kTunings) scene.effects.push_back(tuning.listed);
  return scene;
}

TEST(EffectTune, ToWhatItIsChangesNoBit) {
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    const SimulationDescription scene = with_all(integrator);
    Simulation<float> tuned(scene), untouched(scene);
    for (int step = 0; step < 20; ++step) {
      tuned.set_effects(scene.effects);
      tuned.step();
      untouched.step();
    }
    EXPECT_EQ(state_hash(tuned), state_hash(untouched));
  }
}

TEST(EffectTuneSlow, IsAsIfTheSceneListedThoseNumbers) {
  for (const IntegratorDescription& integrator : kTunedMethods) {
    const SimulationDescription scene = with_all(integrator);
    Simulation<float> untouched(scene);
    steps(untouched, 12);
    for (std::size_t i = 0; i < std::size(kTunings); ++i) {
      SCOPED_TRACE(std::string(name_of(kTunings[i].listed)) + ", method " +
                   std::to_string(integrator.index()));
      SimulationDescription other = scene;
      other.effects[i] = kTunings[i].other;
      Simulation<float> listed(other), tuned(scene);
      tuned.set_effects(other.effects);
      steps(listed, 12);
      steps(tuned, 12);
      EXPECT_EQ(state_hash(tuned), state_hash(listed));
      EXPECT_NE(state_hash(tuned), state_hash(untouched));
      tuned.reset();
      steps(tuned, 12);
      EXPECT_EQ(state_hash(tuned), state_hash(untouched));
    }
  }
}

TEST(EffectTune, WithoutGravityAFreeSheetKeepsItsVelocity) {
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = tuned_sheet(integrator, true);
    scene.effects = {GravityEffect{}};
    Simulation<double> simulation(scene);
    steps(simulation, 30);
    const Vec3 fallen = tuned_velocity(simulation);
    EXPECT_LT((fallen - Vec3(0.25, -9.81 / 2, 0.5)).norm(), 1e-6);  // v + g t, t = 0.5 s
    simulation.set_effects({GravityEffect{{0, 0, 0}}});
    steps(simulation, 30);
    const Vec3 kept = tuned_velocity(simulation);
    EXPECT_LT((kept - fallen).norm(), 1e-5);
    steps(simulation, 120);
    EXPECT_LT((tuned_velocity(simulation) - kept).norm(), 1e-5);
    EXPECT_EQ(simulation.gravity(), Vec3(0, 0, 0));
  }
}

TEST(EffectTune, TerminalSpeedGoesAsTheRootOfDrag) {
  // Face on to its fall, v = sqrt(2 rho_cloth g / (rho_air C_D)), T16: four times the drag, half the speed.
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = tuned_sheet(integrator, true);
    scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(std::acos(-1.0) / 2, Vec3::UnitX()));
    scene.cloths[0].velocity = {0, 0, 0};
    const double density = scene.cloths[0].material.density;
    const auto terminal = [&](double drag) { return std::sqrt(2 * density * 9.81 / (1.225 * drag)); };
    scene.effects = {GravityEffect{}, AerodynamicsEffect{}};
    Simulation<float> simulation(scene);
    steps(simulation, 180);
    EXPECT_NEAR(-tuned_velocity(simulation).y(), terminal(1.2), 1e-3 * terminal(1.2));
    simulation.set_effects({GravityEffect{}, AerodynamicsEffect{1.225, 4.8}});
    steps(simulation, 180);
    EXPECT_NEAR(-tuned_velocity(simulation).y(), terminal(1.2) / 2, 1e-3 * terminal(1.2) / 2);
  }
}

TEST(EffectTune, WakesAClothThatSleeps) {
  SimulationDescription scene = tuned_sheet(Bdf2Description{});
  scene.sleep_speed = 1e-4;
  scene.cloths[0].pins = {{0, 1, 0, 0}};
  scene.cloths[0].velocity = {0, 0, 0};
  scene.cloths[0].material.damping = 0.5;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 2400 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  const double hung = simulation.centre(0).y();
  simulation.set_effects({GravityEffect{{0, -4.905, 0}}, DampingEffect{}});
  EXPECT_FALSE(simulation.cloths()[0].asleep());
  steps(simulation, 120);
  EXPECT_GT(simulation.centre(0).y(), hung);  // it hangs by half the weight
}

TEST(EffectTuneSlow, LayersMoveApartToAGreaterThickness) {
  // Two level sheets without gravity, 5 mm apart: three times the thickness pushes them apart by 10 mm, each
  // by no more than half of that in a step.
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = tuned_sheet(integrator, true);
    ClothDescription& lower = scene.cloths[0];
    lower.min_level = lower.max_level = lower.initial_level = 3;
    lower.velocity = {0, 0, 0};
    lower.orientation = Quaternion(Eigen::AngleAxisd(std::acos(-1.0) / 2, Vec3::UnitX()));
    lower.material.damping = 0.5;
    scene.cloths.push_back(lower);
    scene.cloths[1].position.y() += 0.005;
    scene.effects = {DampingEffect{}, ClothContactEffect{0.005, 0.3}};
    Simulation<float> simulation(scene);
    steps(simulation, 10);
    simulation.set_effects({DampingEffect{}, ClothContactEffect{0.015, 0.3}});
    double fastest = 0;
    for (int step = 0; step < 60; ++step) {
      simulation.step();
      fastest = std::max(fastest, tuned_velocity(simulation).norm());
    }
    EXPECT_GT(simulation.centre(1).y() - simulation.centre(0).y(), 0.99 * 0.015);
    EXPECT_LT(fastest, 0.005 * 60);
  }
}

/// Of any size within the range, and of either sign where that has both; 0 now and then where it may be.
double anywhere(double low, double high, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  if (low <= 0 && share(random) < 0.1) return 0;
  const double least = low > 0 ? low : 1e-6 * high;
  const double size = least * std::pow(high / least, share(random));
  return low < 0 && share(random) < 0.5 ? std::max(low, -size) : size;
}

TEST(EffectTuneSlow, ToAnythingInItsRangeEveryStepStaysFinite) {
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = tuned_sheet(integrator);
    scene.cloths[0].min_level = scene.cloths[0].max_level = scene.cloths[0].initial_level = 3;
    scene.wind = {{0, 0, -1}, 3};
    scene.effects = {GravityEffect{},      PaperWindEffect{}, AerodynamicsEffect{},   StrainDampingEffect{},
                     ClothContactEffect{}, InflationEffect{}, TearingEffect{1e9, 1e9}};
    Simulation<float> simulation(scene);
    std::mt19937 random(1);
    const auto any = [&](double low, double high) { return anywhere(low, high, random); };
    for (int step = 0; step < 120; ++step) {
      simulation.set_effects(
          {GravityEffect{{any(-1e4, 1e4), any(-1e4, 1e4), any(-1e4, 1e4)}}, PaperWindEffect{any(0, 1e6)},
           AerodynamicsEffect{any(0, 1e4), any(0, 100), any(0, 100)}, StrainDampingEffect{any(0, 10)},
           ClothContactEffect{any(1e-4, 1), any(0, 10)}, InflationEffect{any(-1e6, 1e6)},
           TearingEffect{any(0.001, 1e9), any(0.001, 1e9)}});
      simulation.step();
      SCOPED_TRACE(step);
      expect_finite(simulation);
      if (HasFatalFailure()) return;
    }
    EXPECT_TRUE(simulation.healthy());
  }
}

TEST(EffectTuneSlow, GasToAnythingInItsRangeEveryStepStaysFinite) {
  for (const IntegratorDescription& integrator : kTunedMethods) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = tuned_sheet(integrator, true);
    scene.cloths[0].min_level = scene.cloths[0].max_level = scene.cloths[0].initial_level = 3;
    scene.cloths[0].sewn = true;
    scene.effects = {GravityEffect{}, InflationEffect{100, 0.1, 0.5}};
    Simulation<float> simulation(scene);
    std::mt19937 random(1);
    const auto any = [&](double low, double high) { return anywhere(low, high, random); };
    for (int step = 0; step < 120; ++step) {
      InflationEffect gas{any(-1e5, 1e6), any(1e-9, 1e9), any(0, 3600)};
      simulation.set_effects({GravityEffect{}, gas});
      simulation.step();
      SCOPED_TRACE(step);
      expect_finite(simulation);
      if (HasFatalFailure()) return;
    }
    EXPECT_TRUE(simulation.healthy());
  }
}

}  // namespace
}  // namespace weft
