// The stability map, as CSV on the standard output: at which stiffness and step a method is stable.
//   stability_map > map.csv
// Explicit methods, a flat sheet with random velocities: the longest stable step, found by bisection, beside
// the analytic one, 2 / w of its stiffest mode, and beside the step that Weft's choice of substeps rests on,
// which holds whatever way the springs point. The others, swinging down from two corners: stable or not at
// every step.
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "bench/baseline.h"
#include "criteria.h"

namespace weft::stability {
namespace {

constexpr int kLevel = 4;
constexpr double kShearShare = 0.1;  ///< of the structural stiffness

/// By the paper's rules, as the baseline knows no other.
SimulationDescription sheet(double stiffness, double time_step, const IntegratorDescription& integrator) {
  SimulationDescription scene = level_sheet({Method::bdf2, kLevel, 60}, {kTopLeft, kTopRight});
  ClothDescription& cloth = scene.cloths[0];
  cloth.discretization = Discretization::paper;
  cloth.material.structural = stiffness;
  cloth.material.shear = kShearShare * stiffness;
  cloth.material.bending = 0;
  scene.integrator = integrator;
  scene.time_step = time_step;
  scene.sleep_speed = 0;
  return scene;
}

/// The flat sheet alone, every free node with a small velocity of its own.
Simulation<double> shaken(double stiffness, double time_step) {
  SimulationDescription scene = sheet(stiffness, time_step, SymplecticEulerDescription{1});
  scene.effects.clear();
  Simulation<double> simulation(scene);
  Particles<double>& state = simulation.cloths()[0].particles();
  std::mt19937_64 random(1);
  const auto drawn = [&] { return 1e-6 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) {
      if (state.inverse_mass.at(r, c) == 0) continue;
      state.velocity.x.at(r, c) = drawn();
      state.velocity.z.at(r, c) = drawn();  // it lies in the x-z plane
    }
  }
  return simulation;
}

constexpr int kSteps = 1000;
/// An unstable mode of the smallest excess worth telling, 0.1 %, has grown e^60 times in so many steps.
constexpr double kGrown = 1e6;

double fastest(const Simulation<double>& simulation) {
  const Particles<double>& state = simulation.cloths()[0].particles();
  double speed = 0;
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) speed = std::max(speed, state.velocity_at(r, c).norm());
  }
  return speed;
}

bool weft_is_stable(double stiffness, double time_step) {
  Simulation<double> simulation = shaken(stiffness, time_step);
  const double start = fastest(simulation);
  for (int step = 0; step < kSteps; ++step) {
    simulation.step();
    if (!simulation.guard_events().empty() || fastest(simulation) > kGrown * start) return false;
  }
  return true;
}

bool baseline_is_stable(double stiffness, double time_step) {
  const Simulation<double> start = shaken(stiffness, time_step);
  bench::Baseline<double> baseline(start, 1);
  const double limit = kGrown * fastest(start);
  for (int step = 0; step < kSteps; ++step) {
    baseline.step();
    for (const auto& particle : baseline.particles()) {
      const auto& v = particle.velocity;
      if (!(std::abs(v.x) + std::abs(v.y) + std::abs(v.z) < limit)) return false;
    }
  }
  return true;
}

/// The longest stable step, s, to a thousandth: between half and twice `about`.
double longest_step(bool (*stable)(double, double), double stiffness, double about) {
  double low = about / 2, high = about * 2;
  while (high / low > 1.001) {
    const double middle = std::sqrt(low * high);
    (stable(stiffness, middle) ? low : high) = middle;
  }
  return low;
}

/// 2 / w of the wave of one cell's length along the threads, in the flat sheet: every structural spring along
/// it and every shear spring is at work, w^2 = 4 (k + k_s) / m.
double analytic_limit(double stiffness) {
  const double nodes = ((1 << kLevel) + 1) * ((1 << kLevel) + 1);
  const double mass = Material{}.density * kSize * kSize / nodes;
  return std::sqrt(mass / (stiffness * (1 + kShearShare)));
}

double limit_in_any_shape(double stiffness) {
  const Simulation<double> simulation = shaken(stiffness, 1);
  const Cloth<double>& cloth = simulation.cloths()[0];
  return 2 / std::sqrt(cloth.springs().max_squared_frequency(cloth.particles().mass));
}

/// Whether two seconds of swinging keep to the energy they began with.
bool swings_stably(const Setup& setup, const IntegratorDescription& integrator, double stiffness,
                   double time_step) {
  constexpr double kSeconds = 2;
  Simulation<float> simulation(sheet(stiffness, time_step, integrator));
  const EnergyBound bound = energy_bound(simulation, setup, 0);
  for (double time = 0; time < kSeconds; time += time_step) {
    simulation.step();
    const double rise = read(simulation, setup.method != Method::xpbd).energy - bound.start;
    if (!simulation.guard_events().empty() || !(rise <= bound.allowed)) return false;
  }
  return true;
}

void print(const char* method, double stiffness, double time_step, const char* verdict) {
  std::printf("%s,%g,%g,%s\n", method, stiffness, time_step, verdict);
}

void map() {
  std::puts("method,stiffness_N_per_m,step_s,verdict");
  for (int tenths = 0; tenths <= 80; tenths += 5) {
    const double stiffness = std::pow(10, tenths / 10.0), analytic = analytic_limit(stiffness);
    print("analytic", stiffness, analytic, "limit");
    print("any_shape", stiffness, limit_in_any_shape(stiffness), "limit");
    print("baseline", stiffness, longest_step(baseline_is_stable, stiffness, analytic), "limit");
    print("symplectic_euler", stiffness, longest_step(weft_is_stable, stiffness, analytic), "limit");
  }
  for (const Method method : {Method::xpbd, Method::backward_euler, Method::bdf2}) {
    const Setup setup{method, kLevel, 60};
    for (int decade = 0; decade <= 8; ++decade) {
      for (const double rate : {960.0, 480.0, 240.0, 120.0, 60.0, 30.0, 15.0, 10.0}) {
        const double stiffness = std::pow(10, decade);
        const bool stable = swings_stably(setup, integrator_of(setup), stiffness, 1 / rate);
        print(name_of(method), stiffness, 1 / rate, stable ? "stable" : "unstable");
      }
    }
  }
}

}  // namespace
}  // namespace weft::stability

int main() { weft::stability::map(); }
