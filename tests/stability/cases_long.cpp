// Long runs: S14 to S16. Short in CI, in full in the nightly mode.
#include <cmath>
#include <memory>

#include "criteria.h"

namespace weft::stability {
namespace {

Case weightless(std::string name, std::string what, bool sleeps) {
  constexpr long kSteps = 100000;
  constexpr double kDrift = 1e-6;
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {});
    made.effects.clear();
    if (!sleeps) made.sleep_speed = 0;
    return made;
  };
  Case made{std::move(name), std::move(what), {{30, scene}}};
  made.nightly_steps = kSteps;
  made.expect = [=](const Setup&) {
    Expectation expect;
    expect.rests = sleeps;
    return expect;
  };
  made.ending = [](const Simulation<float>& simulation, const Setup&) -> Complaint {
    const Simulation<float> start(simulation.description());
    const double drift = movement(positions(start), positions(simulation)) / kSize;
    if (drift <= kDrift) return {};
    return "drift of " + std::to_string(drift) + " of the size; at most 1e-6";
  };
  return made;
}

Case resting_drape() {
  constexpr double kRadius = 0.3, kSettled = 60, kSpeed = 1e-4, kCreep = 1e-3;
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {});
    made.cloths[0].position = {0, kRadius + 0.05, 0};
    made.balls = {ball({0, 0, 0}, kRadius)};
    made.sleep_speed = 0;
    return made;
  };
  Case made{"S15", "drape on a ball at rest, 10 minutes: speed under 1e-4 m/s, no creep", {{70, scene}}};
  made.nightly_seconds = 600;
  // It is kept from sleeping: asleep nothing moves, however it would creep. Unfolding takes it half a minute
  // at level 6. Speeds are those at which the nodes get on from step to step: their velocities shake within
  // the substeps by as much as single precision rounds their places, 6e-8 m in 1/2800 s and up.
  made.watch = [](const Setup& setup) -> Watch {
    const auto settled = std::make_shared<std::vector<Vec3>>(), last = std::make_shared<std::vector<Vec3>>();
    return [=](const Simulation<float>& simulation, double time) -> Complaint {
      if (time < kSettled) return {};
      const std::vector<Vec3> now = positions(simulation);
      const double speed = last->empty() ? 0 : root_mean_square_movement(*last, now) * setup.hz;
      *last = now;
      if (speed > kSpeed) return "speed of " + std::to_string(speed) + " m/s (rms) at rest; at most 1e-4";
      if (settled->empty()) *settled = now;
      const double creep = movement(*settled, now) / kSize;
      if (creep > kCreep) return "creep of " + std::to_string(creep) + " of the size; at most 1e-3";
      return {};
    };
  };
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.rests = false;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / 2);
    return expect;
  };
  return made;
}

Case a_day() {
  constexpr double kWind = 5, kIntensity = 0.2, kPeak = kWind * (1 + 6 * kIntensity);
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {{0, 0, 0, 1}});
    made.effects.emplace_back(AerodynamicsEffect{});
    made.wind = {{1, 0, 0}, kWind, {kIntensity, 5}, {}, {}};
    return made;
  };
  Case made{"S16", "a flag in gusts for 24 h: clock exact, pinned nodes where they were", {{20, scene}}, {3}};
  made.nightly_seconds = 24 * 3600;
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    const AerodynamicsEffect air;
    Expectation expect;
    // The pressure of six deviations takes the sheet at most from one side to the other.
    expect.input = air.air_density * air.drag * kPeak * kPeak / 2 * kSize * kSize * 2 * kSize;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81);
    expect.rests = false;
    return expect;
  };
  made.watch = [](const Setup& setup) -> Watch {
    const auto steps = std::make_shared<std::uint64_t>(0);
    return [steps, setup](const Simulation<float>& simulation, double) -> Complaint {
      const std::uint64_t made_steps = (*steps)++;
      const double time = static_cast<double>(made_steps) / setup.hz;
      if (simulation.step_count() != made_steps) return "counter of steps is off";
      // Both round once a factor: counted in whole steps, the clock never adds up.
      if (std::abs(simulation.time() - time) > 1e-15 * time) return "clock is off";
      return {};
    };
  };
  made.ending = [](const Simulation<float>& simulation, const Setup&) -> Complaint {
    const Simulation<float> start(simulation.description());
    const Particles<float>&now = simulation.cloths()[0].particles(), &then = start.cloths()[0].particles();
    for (int r = 0; r < now.grid().rows; ++r) {
      if (now.position_at(r, 0) != then.position_at(r, 0)) return "pinned nodes moved";
    }
    return {};
  };
  return made;
}

}  // namespace

std::vector<Case> long_cases() {
  return {
      weightless("S14a", "no gravity, at rest for 1e5 steps: sleeps, drift under 1e-6 of the size", true),
      weightless("S14b", "the same, kept from sleeping", false),
      resting_drape(),
      a_day(),
  };
}

}  // namespace weft::stability
