// A strip that hangs over a rail slides off by its longer side, unless friction holds it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloth/sheet/motion.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kStripLength = 1.2, kStripWidth = 0.1, kRail = 0.1;  // m; the rail's radius
constexpr double kShorter = 0.2;                                      // m, that hangs on one side
constexpr int kCellsOver = 96;

/// Where the strip's middle line lies at a way from its shorter end, m.
Vec3 on_strip(double way, double shorter) {
  const double arc = std::numbers::pi * kRail;
  if (way < shorter) return {kRail, way - shorter, 0};
  if (way > shorter + arc) return {-kRail, shorter + arc - way, 0};
  const double angle = (way - shorter) / kRail;
  return {kRail * std::cos(angle), kRail * std::sin(angle), 0};
}

SimulationDescription strip_over_rail(const IntegratorDescription& integrator, double shorter = kShorter,
                                      double friction = 0) {
  SimulationDescription scene;
  ClothDescription strip;
  strip.size = {kStripWidth, kStripLength};
  strip.base_cells = {1, kCellsOver / 8};
  strip.min_level = strip.initial_level = strip.max_level = 3;
  for (int r = 0; r <= kCellsOver; ++r) {
    const Vec3 place = on_strip(kStripLength * r / kCellsOver, shorter);
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
  rail.friction = friction;
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

// A smooth rail that stands still does no work, whatever slides over it. What presses the strip as it is laid
// on settles in the first steps; then the books hold its work at nothing, to 3 % of the motion's energy.
TEST(SmoothRailThatStands, DoesNoWork) {
  for (const double rate : {15.0, 30.0, 60.0}) {
    for (const IntegratorDescription& method :
         {IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
      SimulationDescription scene = strip_over_rail(method);
      scene.time_step = 1 / rate;
      Simulation<float> simulation(scene);
      double took = 0;
      const double begin = 0.06, end = 0.25;  // s
      for (int step = 0; step < end * rate; ++step) {
        simulation.step();
        if (step > begin * rate) took += simulation.last_advance(0).contact_took;
      }
      const double moving = motion_energy(simulation.cloths()[0].particles(), Freedom::none()).inner;
      EXPECT_GT(moving, 0.005) << "J; it slides";
      EXPECT_NEAR(took, 0, 0.03 * moving) << rate << " Hz, of " << moving << " J";
    }
  }
}

/// Hangs that friction of `holding` just keeps from sliding: over a drum the tension grows by dT = (mu T + w
/// R (mu sin a + cos a)) da for a weight w a length, so that the longer side is L2 = (L1 + k) e^(mu pi) + k
/// with k = 2 mu R / (1 + mu^2) (the capstan's equation, with the weight of what lies on it).
double shorter_side(double holding) {
  const double sides = kStripLength - std::numbers::pi * kRail;
  const double grows = std::exp(holding * std::numbers::pi);
  const double weighs = 2 * holding * kRail / (1 + holding * holding);
  return (sides - weighs * (grows + 1)) / (1 + grows);
}

class Capstan : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Friction, Capstan, ::testing::Values(0.3, 0.5));

TEST_P(Capstan, HoldsAtThreePercentMoreFrictionThanItTakesAndSlipsAtThreePercentLess) {
  const double shorter = shorter_side(GetParam());
  const auto end = [](const Simulation<float>& simulation) {
    return simulation.cloths()[0].particles().position_at(kCellsOver, 4).y();
  };
  Simulation<float> holds(strip_over_rail(Bdf2Description{}, shorter, 1.03 * GetParam()));
  const double begin = end(holds);
  for (int step = 0; step < 60; ++step) holds.step();
  const double held = end(holds);
  // Laid on unstretched it is out of balance and shakes: within a quarter of a cell, 12.5 mm, it takes hold.
  EXPECT_NEAR(held, begin, 12.5e-3 / 4);
  for (int step = 0; step < 600; ++step) holds.step();
  EXPECT_NEAR(end(holds), held, 5e-5) << "and does not creep in 10 s";
  Simulation<float> slips(strip_over_rail(Bdf2Description{}, shorter, 0.97 * GetParam()));
  for (int step = 0; step < 60; ++step) slips.step();
  EXPECT_LT(end(slips), begin - 0.1);
}

}  // namespace weft::test
