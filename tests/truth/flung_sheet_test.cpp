// A sheet held by its edge is flung and folds onto itself: that its layers meet brings in no energy, by
// explicit methods either, which let the layers learn of each other but now and then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth/world/simulation.h"
#include "draws.h"
#include "methods.h"

namespace weft::test {
namespace {

/// A sheet of 1 to 2 m, held by its upper edge, that goes 6 to 16 m/s across it.
ClothDescription flung(Draws& draws) {
  ClothDescription sheet;
  const double size = draws.between(1, 2), speed = draws.between(6, 16), angle = draws.between(0, 6);
  sheet.size = {size, size};
  sheet.material = find_fabric("cotton")->material;
  sheet.min_level = sheet.initial_level = sheet.max_level = 4;
  sheet.velocity = speed * Vec3(0.3 * std::cos(angle), std::sin(angle), std::cos(angle));
  sheet.pins = {{0, 1, 0, 0}};
  return sheet;
}

/// Kinetic and potential energy in a second at 60 Hz, J.
struct Energy {
  double most = 0, mean = 0;
};

Energy energy_of(const ClothDescription& sheet, const IntegratorDescription& integrator, bool contact) {
  SimulationDescription scene;
  scene.cloths = {sheet};
  scene.effects = {GravityEffect{}};
  if (contact) scene.effects.emplace_back(ClothContactEffect{});
  scene.integrator = integrator;
  scene.sleep_speed = 0;
  Simulation<float> simulation(scene);
  Energy energy;
  constexpr int kSteps = 60;
  for (int step = 0; step < kSteps; ++step) {
    simulation.step();
    const auto report = simulation.report(0);
    const double now = report.kinetic_energy + report.potential_energy;
    energy.most = std::max(energy.most, now);
    energy.mean += now / kSteps;
  }
  return energy;
}

// Friction between layers takes energy. Springs that are stretched as layers are kept from crossing may hold
// half as much again for a step or two; what lasts is no more than the method itself errs by.
void expect_no_gain(const IntegratorDescription& integrator) {
  Draws draws;
  constexpr int kSheets = 8;
  for (int i = 0; i < kSheets; ++i) {
    const ClothDescription sheet = flung(draws);
    const Energy alone = energy_of(sheet, integrator, false), meeting = energy_of(sheet, integrator, true);
    EXPECT_LT(meeting.mean, 1.1 * alone.most) << i << ": " << sheet.size.x() << " m";
    EXPECT_LT(meeting.most, 2 * alone.most) << i << ": " << sheet.size.x() << " m";
  }
}

TEST(FlungSheet, GainsNothingByMeetingItselfInSymplecticEuler) {
  expect_no_gain(SymplecticEulerDescription{});
}

TEST(FlungSheet, GainsNothingByMeetingItselfInXpbd) { expect_no_gain(XpbdDescription{}); }

}  // namespace
}  // namespace weft::test
