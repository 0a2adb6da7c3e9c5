// Sheets that lie on, fall on and hang beside one another have no more energy than they began with, whatever
// their masses, and come to rest.
#include <gtest/gtest.h>

#include <numbers>

#include "fixtures.h"
#include "methods.h"
#include "undamped.h"

namespace weft::test {
namespace {

ClothDescription flat(const std::string& fabric, double side, const Vec3& position) {
  ClothDescription sheet;
  sheet.size = {side, side};
  sheet.position = position;
  sheet.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX());
  sheet.material = find_fabric(fabric)->material;
  sheet.min_level = sheet.initial_level = sheet.max_level = 4;
  return sheet;
}

class SheetsOnSheets : public ImplicitMethod {
 protected:
  SheetsOnSheets() {
    scene.effects = {GravityEffect{}, ClothContactEffect{}};
    scene.integrator = integrator();
  }
  /// Runs it; the energy never exceeds that of the start by more than the part, and no spring stretches much.
  Simulation<float> run(double seconds, double part) {
    Simulation<float> simulation(scene);
    const double start = state_energy(simulation).sum();
    double most = start, strain = 0;
    for (double time = 0; time < seconds; time += scene.time_step) {
      simulation.step();
      most = std::max(most, state_energy(simulation).sum());
      for (std::size_t k = 0; k < scene.cloths.size(); ++k)
        strain = std::max(strain, simulation.report(k).strain.max);
    }
    EXPECT_LT(most, start + part * std::abs(start));
    EXPECT_LT(strain, 0.1);
    EXPECT_EQ(simulation.cloths()[0].guard_counters().all_redone(), 0U);
    return simulation;
  }
  static bool asleep(const Simulation<float>& simulation) {
    return std::all_of(simulation.cloths().begin(), simulation.cloths().end(),
                       [](const auto& cloth) { return cloth.asleep(); });
  }
  void lay_floor() {
    scene.obstacles = {{PlaneDescription{}, {0, 0, 0}, 0.4}};
    scene.effects.emplace_back(DampingEffect{});
  }

  SimulationDescription scene;
};

TEST_P(SheetsOnSheets, DenimFallsOnSilk) {
  scene.cloths = {flat("silk", 1, {0, 0.2, 0}), flat("denim", 0.5, {0, 0.5, 0})};
  scene.cloths[0].pins = {{0, 0, 0, 1}, {1, 1, 0, 1}};
  run(2, 1e-3);
}

// 36 times as heavy as the silk.
TEST_P(SheetsOnSheets, HeavyFallsOnLight) {
  scene.cloths = {flat("silk", 1, {0, 0.2, 0}), flat("denim", 0.5, {0.1, 0.25, 0.05})};
  scene.cloths[0].pins = {{0, 0, 0, 1}, {1, 1, 0, 1}};
  scene.cloths[1].material.density = 3;
  run(2, 1e-3);
}

// Their pins hold them nearer to each other, at about 5 mm, than contact asks for: nothing can lead them
// apart there.
TEST_P(SheetsOnSheets, HangCloserThanTheirGap) {
  for (const double apart : {0.003, 0.005}) {
    for (const double x : {0.0, 0.5}) {
      ClothDescription sheet = flat("cotton", 1, {x, 1.2, x > 0 ? apart : 0});
      sheet.orientation = Quaternion::Identity();
      sheet.pins = {{0, 1, 0, 0}};
      sheet.perturbation = 0.001;
      scene.cloths.push_back(sheet);
    }
    run(4, 1e-3);
    scene.cloths.clear();
  }
}

TEST_P(SheetsOnSheets, AStackFallsAsleep) {
  for (int k = 1; k <= 4; ++k) scene.cloths.push_back(flat("cotton", 0.4, {0, 0.006 * k, 0}));
  lay_floor();
  EXPECT_TRUE(asleep(run(6, 1e-3)));
}

TEST_P(SheetsOnSheets, HeavyLiesOnLight) {
  scene.cloths = {flat("silk", 1, {0, 0.01, 0}), flat("denim", 0.5, {0.1, 0.02, 0.05})};
  scene.cloths[1].material.density = 1.5;
  lay_floor();
  EXPECT_TRUE(asleep(run(6, 1e-3)));
}

INSTANTIATE_TEST_SUITE_P(Implicit, SheetsOnSheets, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
