// A sheet that soft pins alone hold to their places falls to where they bear it, and has to move by what its
// weight gives it on the way. Pins, stiffnesses, fabrics, rates and levels as they come.
#include <gtest/gtest.h>

#include "cloth/world/simulation.h"
#include "draws.h"
#include "fixtures.h"
#include "methods.h"

namespace weft::test {
namespace {

class SoftlyHeld : public ImplicitMethod {};

TEST_P(SoftlyHeld, HasNoMoreThanItsWeightGivesIt) {
  constexpr double kEarthsPull = 9.81;
  Draws draws;
  for (int draw = 0; draw < 32; ++draw) {
    SimulationDescription scene;
    ClothDescription cloth;
    cloth.size = {1, 1};
    cloth.material = find_fabric(draws.one_of(std::array{"cotton", "silk", "denim", "wool"}))->material;
    cloth.min_level = cloth.initial_level = cloth.max_level = 3 + draws.below(3);
    PinRegion pin =
        draws.one_of(std::array{PinRegion{0, 1, 0, 1}, PinRegion{0, 1, 0, 0}, PinRegion{0, 1, 0, 0.5}});
    pin.stiffness = std::pow(10, draws.between(1, 4));
    cloth.pins = {pin};
    scene.cloths = {cloth};
    scene.effects = {GravityEffect{}};
    scene.time_step = 1.0 / draws.one_of(std::array{15, 30, 60, 120, 240});
    scene.integrator = integrator();
    scene.sleep_speed = 0;
    Simulation<float> simulation(scene);
    const double weight = simulation.cloths()[0].total_mass() * kEarthsPull;
    // Of the centre of mass. None of 64 had more than the weight gave; 1e-6 m is round-off of positions.
    const auto height = [&] {
      const Particles<float>& particles = simulation.cloths()[0].particles();
      double sum = 0, mass = 0;
      each_node(particles.grid(), [&](int r, int c) {
        sum += double(particles.mass.at(r, c)) * particles.position_at(r, c).y();
        mass += double(particles.mass.at(r, c));
      });
      return sum / mass;
    };
    const double began = height(), sag = weight / *pin.stiffness;
    for (double time = 0; time < 4; time += scene.time_step) {
      simulation.step();
      const double given = weight * (began - height());
      ASSERT_LT(simulation.report(0).kinetic_energy, given + 1e-3 * weight * sag + 1e-6 * weight)
          << "draw " << draw << " at " << time;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Implicit, SoftlyHeld, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
