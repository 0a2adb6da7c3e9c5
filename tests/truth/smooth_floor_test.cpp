// What falls on a floor that does not rub is pushed up alone: its momentum along the floor stays, and its
// energy falls or stays. Sheets of several fabrics, turned as they come, are let go above one.
//
// At 30 Hz a blow still brings in energy now and then (tests/stability/impacts_test.cpp): there it is the
// momentum alone that is tested.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "cloth/sheet/diagnostics.h"
#include "undamped.h"

namespace weft::test {
namespace {

struct Fall {
  IntegratorDescription integrator;
  int level;
  int rate;
};
void PrintTo(const Fall& fall, std::ostream* out) {
  *out << "level " << fall.level << ", " << fall.rate << " Hz";
}

/// Of 1 m x 0.5 m, its middle 0.7 m above a plane without friction.
SimulationDescription falling(const Fall& fall, std::mt19937& random) {
  constexpr std::array<const char*, 4> kFabrics{"denim", "cotton", "silk", "canvas"};
  const auto angle = [&] { return 2 * std::numbers::pi * double(random()) / double(std::mt19937::max()); };
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.size = {1, 0.5};
  sheet.position = {0, 0.7, 0};
  sheet.orientation = Eigen::AngleAxisd(angle(), Vec3::UnitX()) * Eigen::AngleAxisd(angle(), Vec3::UnitZ());
  sheet.material = find_fabric(kFabrics[random() % kFabrics.size()])->material;
  sheet.min_level = sheet.initial_level = sheet.max_level = fall.level;
  sheet.perturbation = 0.001;
  ObstacleDescription floor;
  floor.shape = PlaneDescription{{0, 1, 0}};
  scene.cloths = {sheet};
  scene.obstacles = {floor};
  scene.effects = {GravityEffect{}};
  scene.time_step = 1.0 / fall.rate;
  scene.integrator = fall.integrator;
  return scene;
}

class SmoothFloor : public ::testing::TestWithParam<Fall> {};

TEST_P(SmoothFloor, PushesUpAlone) {
  std::mt19937 random(1);
  for (int sheet = 0; sheet < 8; ++sheet) {
    Simulation<float> simulation(falling(GetParam(), random));
    const Particles<float>& nodes = simulation.cloths()[0].particles();
    const double mass = total_mass(nodes), start = state_energy(simulation).sum(),
                 hit = std::sqrt(2 * 9.81 * 0.7);
    double least = start, rise = 0, along = 0;
    for (int step = 0; step < 3 * GetParam().rate; ++step) {
      simulation.step();
      const double now = state_energy(simulation).sum();
      least = std::min(least, now);
      rise = std::max(rise, now - least);
      const Vec3 momentum = linear_momentum(nodes);
      along = std::max(along, std::hypot(momentum.x(), momentum.z()) / mass);
    }
    const double fell = mass * 9.81 * 0.7;
    EXPECT_LT(along, 1e-3 * hit) << "sheet " << sheet;
    if (GetParam().rate > 30) {
      EXPECT_LT(rise, 0.02 * fell) << "sheet " << sheet;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Implicit, SmoothFloor,
                         ::testing::Values(Fall{Bdf2Description{}, 4, 60}, Fall{Bdf2Description{}, 5, 30},
                                           Fall{Bdf2Description{}, 4, 240},
                                           Fall{BackwardEulerDescription{}, 4, 60},
                                           Fall{BackwardEulerDescription{}, 5, 30}));

}  // namespace
}  // namespace weft::test
