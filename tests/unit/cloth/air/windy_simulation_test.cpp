// Gusts, eddies and zones in a whole simulation.
#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/world/state_hash.h"

namespace weft {
namespace {

SimulationDescription gusty_scene() {
  SimulationDescription scene = test::busy_scene();
  scene.wind.gusts = {0.3, 1.0};
  scene.wind.turbulence = {0.3, 0.3};
  scene.wind.zones = {{SphereZone{0.4}, {0.5, 0, 0}, {0, 0, 3}, 0.2}};
  return scene;
}

template <class Real>
std::uint64_t hash_after(const SimulationDescription& scene, int steps) {
  Simulation<Real> simulation(scene);
  test::run(simulation, steps);
  return state_hash(simulation);
}

TEST(WindySimulation, HasTheBitsOfItsSeed) {
  SimulationDescription scene = gusty_scene(), other = scene;
  other.cloths[0].perturbation = scene.cloths[0].perturbation = 0;  // which the seed decides, too
  other.seed = 2;
  const std::uint64_t hash = hash_after<float>(scene, 30);
  EXPECT_EQ(hash, hash_after<float>(scene, 30));
  EXPECT_NE(hash, hash_after<float>(other, 30));
}

TEST(WindySimulation, BeginsAnewWithAReset) {
  Simulation<float> simulation(gusty_scene());
  test::run(simulation, 20);
  simulation.set_wind({{1, 0, 0}, 9.0});
  test::run(simulation, 20);
  simulation.reset();
  test::run(simulation, 30);
  EXPECT_EQ(state_hash(simulation), hash_after<float>(gusty_scene(), 30));
}

TEST(WindySimulation, NothingIsNoWind) {
  // Intensities of 0 and no zones leave every bit as it is without them.
  SimulationDescription plain = test::busy_scene(), nothing = plain;
  nothing.wind.gusts = {0.0, 1.0};
  nothing.wind.turbulence = {0.0, 0.2};
  EXPECT_EQ(hash_after<float>(plain, 30), hash_after<float>(nothing, 30));
}

TEST(WindySimulation, GustsAreAFunctionOfTimeNotOfSubsteps) {
  // A stiff little sheet in gusts alone gets on by the impulse of the gusts: with 4 times the substeps within
  // 0.1 % of the same way.
  SimulationDescription scene = test::hung_scene();
  scene.cloths[0].pins.clear();
  scene.cloths[0].initial_level = 3;
  scene.effects = {PaperWindEffect{}};
  scene.wind = {{0, 0, -1}, 0.02};
  scene.wind.gusts = {0.5, 0.5};
  const auto end_of = [&](int substeps) {
    scene.integrator = XpbdDescription{substeps};
    Simulation<double> simulation(scene);
    test::run(simulation, 60);
    return simulation.centre(0).z();
  };
  const double few = end_of(40), many = end_of(160);
  EXPECT_GT(std::abs(few), 0.01);
  EXPECT_NEAR(few / many, 1, 0.001);
}

}  // namespace
}  // namespace weft
