// Two free sheets that fly into each other without gravity: what one gives the other takes (Newton's third
// law), and the blow, which is inelastic, brings in no energy. Sheets of 0.3 to 1.5 m of four fabrics at
// levels 3 to 5, 0.3 to 8 m/s, 15 to 120 Hz.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "draws.h"
#include "fixtures.h"
#include "methods.h"

namespace weft::test {
namespace {

struct Sum {
  Vec3 momentum{0, 0, 0}, angular_momentum{0, 0, 0};  ///< N s; N m s, about the origin
  double energy = 0;                                  ///< J
};

Sum sum_of(const Simulation<float>& simulation) {
  Sum sum;
  for (const Cloth<float>& cloth : simulation.cloths()) {
    sum.momentum += linear_momentum(cloth.particles());
    sum.angular_momentum += angular_momentum(cloth.particles());
    sum.energy += kinetic_energy(cloth.particles()) + cloth.sheet().energy(cloth.particles().position);
  }
  return sum;
}

class Blows : Draws {
 public:
  /// The second sheet comes down on the first one, which is at rest.
  SimulationDescription draw(const IntegratorDescription& integrator) {
    SimulationDescription scene;
    for (const bool falls : {false, true}) {
      ClothDescription sheet;
      const double side = between(0.3, 1.5);
      sheet.size = {side, side};
      sheet.position = {between(-0.2, 0.2), falls ? 0.3 * side + between(0.02, 0.3) : 0, between(-0.2, 0.2)};
      sheet.orientation = Eigen::AngleAxisd(-std::numbers::pi / 2 + between(-0.3, 0.3), Vec3::UnitX()) *
                          Eigen::AngleAxisd(between(-0.3, 0.3), Vec3::UnitZ());
      sheet.material = find_fabric(one_of(std::array{"cotton", "silk", "denim", "canvas"}))->material;
      sheet.min_level = sheet.initial_level = sheet.max_level = one_of(std::array{3, 4, 5});
      if (falls) {
        const double down = std::exp(between(std::log(0.3), std::log(8.0)));
        sheet.velocity = {between(-1, 1), -down, between(-1, 1)};
      }
      scene.cloths.push_back(sheet);
    }
    ClothContactEffect contact;
    contact.thickness = 0.005;
    contact.friction = one_of(std::array{0.0, 0.3, 0.6});
    scene.effects = {contact};
    scene.time_step = 1.0 / one_of(std::array{15, 30, 60, 120});
    scene.integrator = integrator;
    return scene;
  }
};

class TwoSheets : public ImplicitMethod {};

// As parts of the momentum, its moment by a lever of 1 m, and the energy that the sheets have beside each
// other. All are exact but for what the solve has missed and is put right after it, and what friction does
// across the gap. Of 1,152 blows drawn otherwise the momentum was off by more than 0.001 in 4, its moment by
// more than 0.05 in 4, and the energy rose by more than 0.05 in 4; of these by 4e-6, 0.13 and 0.025 at most.
TEST_P(TwoSheets, ExchangeMomentumAndGainNoEnergy) {
  constexpr double kLongest = 1.5;  // s
  Blows blows;
  int met = 0;
  const int blows_drawn = sample(32);
  for (int blow = 0; blow < blows_drawn; ++blow) {
    const SimulationDescription scene = blows.draw(integrator());
    Simulation<float> simulation(scene);
    const double one = total_mass(simulation.cloths()[0].particles()),
                 other = total_mass(simulation.cloths()[1].particles()), mass = one * other / (one + other),
                 speed = scene.cloths[1].velocity.norm();
    const Sum start = sum_of(simulation);
    double most = 0, momentum = 0, angular = 0;
    for (double time = 0; time < kLongest; time += scene.time_step) {
      simulation.step();
      const Sum now = sum_of(simulation);
      most = std::max(most, now.energy - start.energy);
      momentum = std::max(momentum, (now.momentum - start.momentum).norm());
      angular = std::max(angular, (now.angular_momentum - start.angular_momentum).norm());
    }
    const auto what = [&] {
      return ::testing::Message() << "blow " << blow << " of " << speed << " m/s, " << one << " and " << other
                                  << " kg, " << scene.time_step << " s";
    };
    EXPECT_LT(momentum, 1e-3 * mass * speed) << what();
    EXPECT_LT(angular, 0.2 * mass * speed) << what();
    EXPECT_LT(most, 0.05 * mass * speed * speed / 2) << what();
    EXPECT_TRUE(simulation.guard_events().empty()) << what();
    if (sum_of(simulation).energy < start.energy - 0.01 * mass * speed * speed / 2) ++met;
  }
  EXPECT_GT(met, blows_drawn / 2) << "hardly any touched";
}

INSTANTIATE_TEST_SUITE_P(Implicit, TwoSheets, ::testing::ValuesIn(kImplicitMethods), name_of_case);
INSTANTIATE_TEST_SUITE_P(Nightly, TwoSheets, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
