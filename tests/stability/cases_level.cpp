// The level changed at every step, 4-5-6-5-4: S11.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "criteria.h"

namespace weft::stability {
namespace {

constexpr int kFixedLevel = 5;

int level_at(double time, double time_step) {
  constexpr int kLevels[] = {4, 5, 6, 5};
  return kLevels[std::lround(time / time_step) % 4];
}

/// Compares the energy with the highest of the same scene's at the fixed levels it goes through: above it by
/// at most 1 % of all that can move. One shape's elastic energy differs from level to level, that of bent
/// springs by h^4 (2 h of them is shortened by (2 h)^3 k^2 / 24 at curvature k): of a sheet wrapped round
/// something only what becomes motion and height is compared. XPBD's springs never count (criteria.h).
Watch no_more_energy_than_fixed(const Phase& phase, const Setup& setup, bool wrapped) {
  std::vector<std::shared_ptr<Simulation<float>>> fixed;
  for (const int level : {4, 5, 6}) {
    SimulationDescription scene = phase.scene(setup);
    scene.cloths[0].initial_level = level;
    fixed.push_back(std::make_shared<Simulation<float>>(scene));
  }
  const Setup strict{Method::bdf2, setup.level, setup.hz};  // 1 % for all methods: both runs are the method's
  const double room = energy_bound(*fixed[0], strict, 0).allowed;
  const bool springs_count = setup.method != Method::xpbd && !wrapped;
  return [=](const Simulation<float>& simulation, double time) -> Complaint {
    double highest = -std::numeric_limits<double>::infinity();
    for (const auto& each : fixed) {
      if (time > 0) each->step();
      highest = std::max(highest, read(*each, springs_count).energy);
    }
    const double above = read(simulation, springs_count).energy - highest;
    if (above <= room) return {};
    return "level changes bring in " + std::to_string(above) + " J over the fixed levels; at most " +
           std::to_string(room);
  };
}

Case changing(std::string name, std::string what, double from, bool wrapped,
              std::function<SimulationDescription(const Setup&)> base) {
  const auto scene = [base = std::move(base)](const Setup& setup) {
    SimulationDescription made = base(setup);
    made.cloths[0].min_level = 4;
    made.cloths[0].max_level = 6;
    // The finest level's step serves them all.
    if (setup.method == Method::explicit_fixed) made.integrator = integrator_of({setup.method, 6, setup.hz});
    return made;
  };
  Case made{std::move(name), std::move(what), {{4, scene}}, {kFixedLevel}};
  made.drive = [=](Simulation<float>& simulation, double time) {
    if (time >= from) simulation.request_level(0, level_at(time, simulation.description().time_step));
  };
  made.watch = [phase = made.phases[0], wrapped](const Setup& setup) {
    return no_more_energy_than_fixed(phase, setup, wrapped);
  };
  made.expect = [scene](const Setup& setup) {
    SimulationDescription hung = scene(setup);
    hung.cloths[0].initial_level = hung.cloths[0].max_level;
    Expectation expect;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / 2);
    expect.rests = false;  // its nodes change
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> level_cases() {
  constexpr double kRadius = 0.3;
  return {
      changing("S11a", "level changed at every step while falling freely: no energy gained", 0, false,
               [](const Setup& setup) {
                 SimulationDescription made = level_sheet(setup, {});
                 made.cloths[0].perturbation = 0.01;
                 return made;
               }),
      changing("S11b", "the same while draped on a ball: no node in it", 1, true,
               [](const Setup& setup) {
                 SimulationDescription made = level_sheet(setup, {});
                 made.cloths[0].position = {0, kRadius + 0.05, 0};
                 made.balls = {ball({0, 0, 0}, kRadius)};
                 return made;
               }),
      changing("S11c", "the same while swinging from two corners", 0, false,
               [](const Setup& setup) {
                 return level_sheet(setup, {kTopLeft, kTopRight});
               }),
  };
}

}  // namespace weft::stability
