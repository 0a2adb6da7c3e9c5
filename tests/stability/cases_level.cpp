// The level changed at every step, 4-5-6-5-4: S11.
#include <cmath>
#include <memory>

#include "criteria.h"

namespace weft::stability {
namespace {

constexpr int kFixedLevel = 5;

int level_at(double time, double time_step) {
  constexpr int kLevels[] = {4, 5, 6, 5};
  return kLevels[std::lround(time / time_step) % 4];
}

/// Compares the energy with the same scene's at a fixed level: above it by at most 1 % of all that can move.
/// XPBD hangs longer the finer the level is (shape_test.cpp): its energy is compared with the coarsest one's.
Watch no_more_energy_than_fixed(const Phase& phase, const Setup& setup) {
  SimulationDescription scene = phase.scene(setup);
  if (setup.method == Method::xpbd) scene.cloths[0].initial_level = scene.cloths[0].min_level;
  const auto fixed = std::make_shared<Simulation<float>>(scene);
  const Setup strict{Method::bdf2, setup.level, setup.hz};  // 1 % for all methods: both runs are the method's
  const double room = energy_bound(*fixed, strict, 0).allowed;
  const bool springs_count = setup.method != Method::xpbd;
  return [=](const Simulation<float>& simulation, double time) -> Complaint {
    if (time > 0) fixed->step();
    const double above = read(simulation, springs_count).energy - read(*fixed, springs_count).energy;
    if (above <= room) return {};
    return "level changes bring in " + std::to_string(above) + " J over the fixed level; at most " +
           std::to_string(room);
  };
}

Case changing(std::string name, std::string what, double from,
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
  made.watch = [phase = made.phases[0]](const Setup& setup) {
    return no_more_energy_than_fixed(phase, setup);
  };
  made.expect = [scene](const Setup& setup) {
    SimulationDescription hung = scene(setup);
    hung.cloths[0].initial_level = hung.cloths[0].max_level;
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / 2);
    expect.rests = false;  // its nodes change
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> level_cases() {
  constexpr double kRadius = 0.3;
  return {
      changing("S11a", "level changed at every step while falling freely: no energy gained", 0,
               [](const Setup& setup) {
                 SimulationDescription made = level_sheet(setup, {});
                 made.cloths[0].perturbation = 0.01;
                 return made;
               }),
      changing("S11b", "the same while draped on a ball: no node in it", 1,
               [](const Setup& setup) {
                 SimulationDescription made = level_sheet(setup, {});
                 made.cloths[0].position = {0, kRadius + 0.05, 0};
                 made.balls = {ball({0, 0, 0}, kRadius)};
                 return made;
               }),
      changing("S11c", "the same while swinging from two corners", 0,
               [](const Setup& setup) {
                 return level_sheet(setup, {kTopLeft, kTopRight});
               }),
  };
}

}  // namespace weft::stability
