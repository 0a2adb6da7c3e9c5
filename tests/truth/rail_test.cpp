// A strip that hangs over a smooth rail slides off by its longer side.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kStripLength = 1.2, kStripWidth = 0.1, kRail = 0.1;  // m; the rail's radius
constexpr double kShorter = 0.2;                                      // m, that hangs on one side
constexpr int kCellsOver = 96;

/// Where the strip's middle line lies at a way from its shorter end, m.
Vec3 on_strip(double way) {
  const double arc = std::numbers::pi * kRail;
  if (way < kShorter) return {kRail, way - kShorter, 0};
  if (way > kShorter + arc) return {-kRail, kShorter + arc - way, 0};
  const double angle = (way - kShorter) / kRail;
  return {kRail * std::cos(angle), kRail * std::sin(angle), 0};
}

SimulationDescription strip_over_rail(const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription strip;
  strip.size = {kStripWidth, kStripLength};
  strip.base_cells = {1, kCellsOver / 8};
  strip.min_level = strip.initial_level = strip.max_level = 3;
  for (int r = 0; r <= kCellsOver; ++r) {
    const Vec3 place = on_strip(kStripLength * r / kCellsOver);
    for (int c = 0; c <= 8; ++c) strip.nodes.push_back(place + Vec3(0, 0, kStripWidth * (c / 8.0 - 0.5)));
  }
  strip.material.density = 0.2;
  strip.material.bending = 0.1;
  strip.material.damping = 0;
  scene.cloths = {strip};
  ObstacleDescription rail;
  CapsuleDescription round{kRail, 1};
  round.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  rail.shape = round;
  scene.obstacles = {rail};
  scene.effects = {GravityEffect{}};
  scene.integrator = integrator;
  return scene;
}

class SmoothRail : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(AllMethods, SmoothRail,
                         ::testing::Values(SymplecticEulerDescription{}, BackwardEulerDescription{},
                                           Bdf2Description{}, XpbdDescription{}),
                         [](const auto& test) {
                           return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
                         });

}  // namespace

// A chain over a smooth pulley: of its length L the sides differ by d + 2 s, so s'' = g (d + 2 s) / L, and s
// = d / 2 (cosh(w t) - 1) with w^2 = 2 g / L.
TEST_P(SmoothRail, AStripSlidesAsAChainOverAPulley) {
  Simulation<float> simulation(strip_over_rail(GetParam()));
  const auto lower_end = [&] { return simulation.cloths()[0].particles().position_at(kCellsOver, 4).y(); };
  const double begin = lower_end();
  constexpr int kSteps = 12;
  for (int step = 0; step < kSteps; ++step) simulation.step();
  const double time = kSteps / 60.0, rate = std::sqrt(2 * 9.81 / kStripLength);
  const double differ = kStripLength - std::numbers::pi * kRail - 2 * kShorter;
  const double way = differ / 2 * (std::cosh(rate * time) - 1);
  // Or by what it goes in the last step: backward Euler is of first order.
  const double last_step = differ / 2 * rate * std::sinh(rate * time) / 60;
  const bool first_order = std::holds_alternative<BackwardEulerDescription>(GetParam());
  EXPECT_NEAR(begin - lower_end(), way, first_order ? last_step : 0.1 * way) << way << " m";
  EXPECT_NEAR(simulation.cloths()[0].particles().position_at(kCellsOver, 4).x(), -kRail, 0.1 * way)
      << "it hangs where it hung";
}

}  // namespace weft::test
