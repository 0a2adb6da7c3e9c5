// Backward Euler and BDF2: one spring's amplitude and frequency (T3, T4), free fall (T1), drag (T2), hopeless
// starts, a ball that leaves. What every integrator must do is in tests/truth.
#include "cloth/integrators/implicit.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::kFrame;
using test::Rig;
using test::set;

/// Solved to rounding, or nearly.
template <class Description>
Description exactly() {
  Description description;
  description.tolerance = 1e-12;
  description.linear_iterations = 1000;
  return description;
}

/// The middle column of 2 x 3 nodes 1 m apart swings along x between held ones, on springs of k each: w^2 =
/// 2k / 1 kg.
Rig<double> oscillator(double k, const IntegratorDescription& stepping) {
  Particles<double> sheet = test::flat_sheet<double>(2, 3, {2, 1});
  for (int r : {0, 1}) {
    for (int c : {0, 2}) sheet.inverse_mass.at(r, c) = 0;
    set(sheet.position, r, 1, get(sheet.position, r, 1) + Vec3(0.01, 0, 0));
  }
  Material material = test::without_springs();
  material.structural = k;
  return {std::move(sheet), {2, 1}, material, Discretization::paper, {}, stepping};
}

/// Amplification of one step of a method whose characteristic polynomial's principal root is `root`, over a
/// period.
struct Wave {
  double amplitude;  ///< kept per period
  double frequency;  ///< relative to w
};
Wave of_root(const std::complex<double>& root, int steps_a_period) {
  return {std::pow(std::abs(root), steps_a_period),
          std::abs(std::arg(root)) * steps_a_period / (2 * std::numbers::pi)};
}
/// y' = i w y: (1 - i w h) y1 = y0.
Wave backward_euler_wave(int n) {
  const std::complex<double> z(0, 2 * std::numbers::pi / n);
  return of_root(1.0 / (1.0 - z), n);
}
/// (3/2 - i w h) y2 - 2 y1 + y0/2 = 0.
Wave bdf2_wave(int n) {
  const std::complex<double> z(0, 2 * std::numbers::pi / n);
  return of_root((2.0 + std::sqrt(1.0 + 2.0 * z)) / (3.0 - 2.0 * z), n);
}

/// Measured over `periods` periods of n steps from the second on: an analytic signal x + i v/w decays and
/// turns by the method's principal root once the start has died away.
Wave measured(const IntegratorDescription& stepping, int n, int periods) {
  constexpr double k = 100;
  const double w = std::sqrt(2 * k);
  Rig<double> rig = oscillator(k, stepping);
  const double h = 2 * std::numbers::pi / w / n;
  std::complex<double> first, previous;
  double angle = 0;
  for (int step = 0; step <= n * (periods + 1); ++step) {
    const std::complex<double> now(get(rig.particles.position, 0, 1).x(),
                                   -get(rig.particles.velocity, 0, 1).x() / w);
    if (step == n) first = now;
    if (step > n) angle += std::arg(now / previous);
    previous = now;
    rig.advance(step * h, h);
  }
  return {std::pow(std::abs(previous / first), 1.0 / periods),
          std::abs(angle) / (2 * std::numbers::pi * periods)};
}

// T3 and T4: the table's numbers come from the methods' characteristic roots, which these are.
TEST(Implicit, WavesOfTheTable) {
  EXPECT_NEAR(backward_euler_wave(20).amplitude, 0.390144, 1e-6);
  EXPECT_NEAR(backward_euler_wave(20).frequency, 0.968922, 1e-6);
  EXPECT_NEAR(bdf2_wave(20).amplitude, 0.961631, 1e-6);
  EXPECT_NEAR(bdf2_wave(20).frequency, 0.970709, 1e-6);
  EXPECT_NEAR(bdf2_wave(200).amplitude, 0.999951, 1e-6);
}

TEST(Implicit, BackwardEulersSpringKeepsAmplitudeAndFrequencyOfTheory) {
  for (const int n : {20, 60, 200}) {
    const Wave expected = backward_euler_wave(n), wave = measured(exactly<BackwardEulerDescription>(), n, 2);
    EXPECT_NEAR(wave.amplitude, expected.amplitude, 1e-6) << n;
    EXPECT_NEAR(wave.frequency, expected.frequency, 1e-6) << n;
  }
}

TEST(Implicit, Bdf2sSpringKeepsAmplitudeAndFrequencyOfTheory) {
  for (const int n : {20, 60, 200}) {
    const Wave expected = bdf2_wave(n), wave = measured(exactly<Bdf2Description>(), n, 2);
    EXPECT_NEAR(wave.amplitude, expected.amplitude, 1e-6) << n;
    EXPECT_NEAR(wave.frequency, expected.frequency, 1e-6) << n;
  }
}

/// Speed and fall of a sheet without springs after one second.
template <class Description>
std::pair<double, double> fall(const std::vector<EffectDescription>& effects) {
  Rig<double> rig = test::sheet_rig<double>(9, 9, exactly<Description>(), effects, test::without_springs());
  rig.cloth.material.damping = 0.3;  // N s/m3; 0.1 kg/m2: c/m = 3 /s
  const double start = get(rig.particles.position, 4, 4).y();
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  return {get(rig.particles.velocity, 4, 4).y(), get(rig.particles.position, 4, 4).y() - start};
}

// T1. Backward Euler's fall is -g h^2 n(n+1)/2; BDF2 starts with one such step and its parabola is then exact
// but for that start: x'' = -g solved by BDF2 twice.
TEST(Implicit, FreeFall) {
  const auto [euler_speed, euler_fall] = fall<BackwardEulerDescription>({GravityEffect{}});
  EXPECT_NEAR(euler_speed, -9.81, 1e-12);
  EXPECT_NEAR(euler_fall, -9.81 * kFrame * kFrame * 60 * 61 / 2, 1e-12);
  const auto [speed, distance] = fall<Bdf2Description>({GravityEffect{}});
  EXPECT_NEAR(speed, -9.81, 1e-12);
  double v[2] = {0, -9.81 * kFrame}, x[2] = {0, -9.81 * kFrame * kFrame};
  for (int step = 1; step < 60; ++step) {
    const double next_v = (4 * v[1] - v[0] - 2 * kFrame * 9.81) / 3,
                 next_x = (4 * x[1] - x[0] + 2 * kFrame * next_v) / 3;
    v[0] = std::exchange(v[1], next_v);
    x[0] = std::exchange(x[1], next_x);
  }
  EXPECT_NEAR(distance, x[1], 1e-12);
  EXPECT_NEAR(distance, -4.905, 9.81 * kFrame * kFrame);  // the start's error: at most g h^2
}

// T2: v' = -g - 3 v. Backward Euler: v1 (1 + 3h) = v0 - g h.
TEST(Implicit, DragIsSolvedWithTheRest) {
  double v = 0;
  for (int step = 0; step < 60; ++step) v = (v - 9.81 * kFrame) / (1 + 3 * kFrame);
  EXPECT_NEAR(fall<BackwardEulerDescription>({GravityEffect{}, DampingEffect{}}).first, v, 1e-12);
  EXPECT_NEAR(fall<Bdf2Description>({GravityEffect{}, DampingEffect{}}).first,
              -9.81 / 3 * (1 - std::exp(-3.0)),
              9.81 / 3 * std::exp(-3.0) * 9 * kFrame * kFrame * 2);  // second order: (c h)^2
}

// Stiff, slack and hopeless: finite, and never more energy than there was.
TEST(ImplicitSlow, SurvivesWhatItCannotSolve) {
  for (const double stiffness : {1e-1, 1e7}) {
    for (const bool collapsed : {false, true}) {
      Material material;
      material.structural = stiffness;
      Rig<float> rig = test::hung_rig<float>(17, 17, BackwardEulerDescription{}, {GravityEffect{}}, material);
      if (collapsed) {
        each_node(rig.particles.grid(),
                  [&](int r, int c) { set(rig.particles.position, r, c, Vec3::Zero()); });
      } else {
        test::randomise(rig.particles.position, -1, 1, 5);
      }
      const auto energy = [&] {
        return kinetic_energy(rig.particles) + rig.springs().energy(rig.particles.position) +
               gravitational_energy(rig.particles, standard_gravity());
      };
      const double before = energy();
      for (int step = 0; step < 120; ++step) rig.advance(step * kFrame, kFrame);
      EXPECT_TRUE(is_finite(rig.particles)) << stiffness << collapsed;
      EXPECT_LE(energy(), before) << stiffness << collapsed;
    }
  }
}

/// In the x-y plane, about its middle, rad/s.
void spin(double speed, Particles<double>& sheet) {
  each_node(sheet.grid(), [&](int r, int c) {
    set(sheet.velocity, r, c, Vec3(0, 0, speed).cross(get(sheet.position, r, c)));
  });
}

// Half a turn a frame: a linearised spring does not notice that its ends fly apart.
TEST(Implicit, WhatTurnsFastGainsNoEnergy) {
  for (const int newton_iterations : {1, 3}) {
    Bdf2Description stepping;
    stepping.newton_iterations = newton_iterations;
    Material material;
    material.structural = 50000;
    Rig<double> rig = test::sheet_rig<double>(17, 17, stepping, {}, material);
    spin(180, rig.particles);
    const auto energy = [&] {
      return kinetic_energy(rig.particles) + rig.springs().energy(rig.particles.position);
    };
    const double before = energy();
    for (int step = 0; step < 30; ++step) {
      rig.advance(step * kFrame, kFrame);
      // What it turns with is kept up to that energy, but for rounding.
      EXPECT_LE(energy(), before * (1 + 1e-12)) << newton_iterations << ' ' << step;
    }
  }
}

// Nodes that fly apart at random on springs of 1e8 N/m, and turns of 5 rad a frame: iterating does not get
// there, the line search does.
TEST(Implicit, WildMotionGainsNoEnergy) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    for (const double stiffness : {5e5, 1e8}) {
      for (const double speed : {0.0, 300.0}) {
        Material material;
        material.structural = stiffness;
        Rig<float> rig = test::hung_rig<float>(17, 17, stepping, {}, material);
        Particles<float> noise(rig.particles.grid());
        test::randomise(noise.velocity, -10, 10, 6);
        each_node(noise.grid(), [&](int r, int c) {
          if (rig.particles.inverse_mass.at(r, c) == 0) return;
          const Vec3 turning = Vec3(0, 0, speed).cross(get(rig.particles.position, r, c));
          set(rig.particles.velocity, r, c, turning + get(noise.velocity, r, c));
        });
        const auto energy = [&] {
          return kinetic_energy(rig.particles) + rig.springs().energy(rig.particles.position);
        };
        const double before = energy();
        for (int step = 0; step < 20; ++step) {
          rig.advance(step * kFrame, kFrame);
          EXPECT_LE(energy(), before) << stepping.index() << ' ' << stiffness << ' ' << speed << ' ' << step;
        }
      }
    }
  }
}

// A flat sheet that nothing pulls has only forces of rounding, about 6e-8 of its place times the stiffness:
// springs that are so off hold 4e-9 J each. (It flew apart with 3 to 8 J where energies that differ by
// rounding passed for a gain.)
TEST(ImplicitSlow, StiffSheetAtRestStaysThere) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription(Bdf2Description{}), IntegratorDescription(BackwardEulerDescription{})}) {
    for (const double stiffness : {1e5, 6e5, 3e6}) {
      SimulationDescription scene;
      ClothDescription sheet;
      sheet.size = {0.3, 0.3};
      sheet.min_level = sheet.max_level = sheet.initial_level = 5;
      sheet.material.structural = stiffness;
      sheet.material.density = 0.05;
      sheet.material.damping = 0;
      sheet.position = {1.3, 0.7, -0.4};
      sheet.orientation = Quaternion(Eigen::AngleAxisd(-1.3, Vec3::UnitX()));
      scene.cloths = {sheet};
      scene.integrator = stepping;
      scene.sleep_speed = 0;
      Simulation<float> simulation(scene);
      for (int step = 0; step < 60; ++step) simulation.step();
      const ClothReport report = simulation.report(0);
      EXPECT_LT(report.kinetic_energy + report.potential_energy, 1e-4) << stiffness;
    }
  }
}

// A sheet that moves on and turns nothing is linear: one iteration, whatever is allowed. One that turns by
// 0.1 rad a frame is not.
TEST(Implicit, FurtherLinearisationsOnlyWhereTheyAreNeeded) {
  const auto solves = [](double turn, int newton_iterations) {
    Bdf2Description stepping;
    stepping.newton_iterations = newton_iterations;
    Rig<double> rig = test::sheet_rig<double>(9, 9, stepping, {GravityEffect{}});
    spin(turn / kFrame, rig.particles);
    return rig.advance(0, kFrame).linear_iterations;
  };
  EXPECT_GT(solves(0, 1), 0);
  EXPECT_EQ(solves(0, 3), solves(0, 1));
  EXPECT_GT(solves(0.1, 3), solves(0.1, 1));
}

/// A sheet of 2 m, hung by two corners, whose rows lie on one another in pleats: it unfolds.
SimulationDescription unfolding(const IntegratorDescription& stepping) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {2, 2};
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  const int cells = 1 << 4;
  for (int r = 0; r <= cells; ++r) {
    for (int c = 0; c <= cells; ++c) {
      const double across = (r % 2 == 1 && c > 0 && c < cells ? -1 : 1) * (2.0 * c / cells - 1);
      cloth.nodes.emplace_back(across, 1 - 2.0 * r / cells, 1e-3 * (c % 3));
    }
  }
  scene.cloths = {cloth};
  scene.cloths[0].material.damping = 0.5;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = stepping;
  scene.time_step = 1.0 / 15;
  scene.sleep_speed = 0;
  return scene;
}

// Near rest gravity would give a node 0.65 m/s in a step of 1/15 s did not the springs hold it: a share of
// that is no error to allow to a motion of millimetres a second. The error in a step's velocities is at most
// twice (in the solve, and in what it solves) the tolerance's share of the motion, or of 1 mm/s (kSlow).
TEST(ImplicitSlow, ErrorsNearRestAreASmallShareOfTheMotion) {
  BackwardEulerDescription stepping, converged = exactly<BackwardEulerDescription>();
  converged.newton_iterations = 30;
  // What the formula takes is none of the solves' errors.
  stepping.liveliness = converged.liveliness = 0;
  Simulation<double> simulation(unfolding(stepping));
  const auto speed = [](const Particles<double>& state, const Particles<double>* other) {
    double sum = 0;
    each_node(state.grid(), [&](int r, int c) {
      const Vec3 v = get(state.velocity, r, c);
      sum += (other == nullptr ? v : Vec3(v - get(other->velocity, r, c))).squaredNorm();
    });
    return std::sqrt(sum / static_cast<double>(state.grid().size()));
  };
  int near_rest = 0;
  for (int step = 0; step < 5 * 15; ++step) {
    const Particles<double>& state = simulation.cloths()[0].particles();
    const double moving = speed(state, nullptr);
    if (step >= 30 && moving < 5e-3) {  // it takes a second to snap out of its pleats
      ++near_rest;
      Simulation<double> ours(unfolding(stepping)), exact(unfolding(converged));
      ours.cloths()[0].particles() = exact.cloths()[0].particles() = state;
      ours.step();
      exact.step();
      const double off = speed(ours.cloths()[0].particles(), &exact.cloths()[0].particles());
      const double motion = std::max(moving, speed(exact.cloths()[0].particles(), nullptr));
      EXPECT_LE(off, 2 * stepping.tolerance * std::hypot(motion, 1e-3)) << step;
    }
    simulation.step();
  }
  EXPECT_GT(near_rest, 30);
}

// A ball carries a free sheet upwards at 1 m/s and then leaves downwards at 5 m/s: it may push, never pull.
// The sheet goes on at the 1 m/s it has, but for what a contact gives in a step (DECISIONS.md, kDepth): 0.04
// g h.
TEST(Implicit, BallThatLeavesLetsTheSheetGo) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {0.2, 0.2};
  cloth.min_level = cloth.max_level = cloth.initial_level = 3;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.position = {0, 1e-6, 0};
  scene.cloths = {cloth};
  BallDescription ball;
  ball.radius = 1000;  // flat under the sheet
  ball.path = {{0, {0, -1000, 0}}, {0.1, {0, -999.9, 0}}, {1.1, {0, -1004.9, 0}}};
  scene.balls = {ball};
  scene.integrator = exactly<BackwardEulerDescription>();
  Simulation<double> simulation(scene);
  const auto speed = [&] { return linear_momentum(simulation.cloths()[0].particles()).y() / (0.1 * 0.04); };
  const double gives = 9.81 / 32 / 60;
  for (int step = 0; step < 6; ++step) simulation.step();
  EXPECT_NEAR(speed(), 1, gives);
  const double carried = speed();
  for (int step = 0; step < 6; ++step) simulation.step();
  EXPECT_NEAR(speed(), carried, 1e-9) << "nothing pulls";
}

}  // namespace
}  // namespace weft
