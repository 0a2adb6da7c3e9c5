// What tells a sheet that still comes to rest from one that never does.
#include "criteria.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace weft::stability {
namespace {

/// Of 30 s at 60 Hz.
bool falls(const std::function<double(double time)>& energy) {
  constexpr long kSteps = 1800;
  EnergyFall fall(kSteps);
  for (long step = 1; step <= kSteps; ++step) fall.add(energy(static_cast<double>(step) / 60));
  return fall.falls();
}

double sine(double period, double time) { return std::sin(2 * std::numbers::pi * time / period); }

TEST(EnergyFall, OfASheetThatUnfoldsWhateverItSwings) {
  // Slow, a millionth of a joule a minute, beside which rounding shakes the last digits of -4 J.
  EXPECT_TRUE(falls([](double t) { return -4 - 1e-6 / 60 * t + 1e-8 * sine(0.0371, t); }));
  // A fold that lies for 15 s, then opens.
  EXPECT_TRUE(falls([](double t) { return t < 15 ? 1.0 - 1e-9 * t : 0.5 - 1e-9 * t; }));
  // Swings of 0.3 J that die away over 4 s: from e^-10/4 on they are 0.02 J.
  EXPECT_TRUE(falls([](double t) { return std::exp(-t / 4) * (1.5 + 0.3 * sine(2, t)) - 0.1 * t; }));
}

TEST(EnergyFall, NotOfALimitCycleHoweverSmall) {
  for (const double period : {2.0 / 60, 0.5, 3.7, 9.9}) {
    for (const double amplitude : {1.0, 1e-12}) {
      EXPECT_FALSE(falls([&](double t) { return amplitude * sine(period, t); })) << period << " s";
    }
  }
}

TEST(EnergyFall, NotOfWhatStaysOrRises) {
  EXPECT_FALSE(falls([](double) { return -4.0; }));
  EXPECT_FALSE(falls([](double t) { return 1e-9 * t; }));
  // It loses energy at first and then none: this half minute it may have come to rest, the next it has not.
  const auto settled = [](double t) { return std::max(0.0, 1 - t / 5); };
  EXPECT_TRUE(falls([](double t) { return std::exp(-t); }));
  EXPECT_FALSE(falls([&](double t) { return settled(t + 30); }));
}

// A rail of 10 cm through the middle of a cell of 25 cm that is drawn to twice that: no node is near it.
TEST(Pierced, IsWhatHasASolidWithinTheMostStretchedSpring) {
  SimulationDescription made = ordinary_sheet({Method::bdf2, 3}, {});
  made.obstacles = {{.shape = CapsuleDescription{0.05, 1}}};
  Simulation<float> simulation(made);
  simulation.step();
  Particles<float>& sheet = simulation.cloths()[0].particles();
  const Grid& grid = sheet.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const Vec2 at(2.0 * c / (grid.cols - 1) - 1, 1 - 2.0 * r / (grid.rows - 1));
      sheet.position.x.at(r, c) = static_cast<float>(at.x());
      sheet.position.y.at(r, c) = static_cast<float>(at.y());
      sheet.position.z.at(r, c) = 0.3F;
    }
  }
  EXPECT_FALSE(is_pierced(simulation));
  sheet.position.x.at(4, 4) = 0.25F;
  sheet.position.x.at(4, 5) = 0.75F;
  EXPECT_FALSE(is_pierced(simulation)) << "stretched beside it";
  sheet.position.z.at(4, 4) = sheet.position.z.at(4, 5) = 0;
  sheet.position.x.at(4, 4) = -0.25F;
  sheet.position.x.at(4, 5) = 0.25F;
  EXPECT_TRUE(is_pierced(simulation));
  sheet.position.x.at(8, 8) = 3;
  EXPECT_FALSE(is_pierced(simulation)) << "another one is stretched farther";
}

}  // namespace
}  // namespace weft::stability
