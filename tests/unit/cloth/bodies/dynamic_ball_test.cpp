// Balls that yield to the cloth: hits, momentum, energy, rest.
#include <gtest/gtest.h>

#include <numbers>

#include "busy_scene.h"
#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"
#include "loose_contact.h"

namespace weft {
namespace {

using test::ball_at;
using test::each_node;
using test::get;
using test::run;
using test::set;

constexpr double kMasses[] = {1e-3, 0.03, 1, 30, 1e3};  // kg

Solid ball_of(double mass, const Vec3& velocity) {
  Solid ball;
  ball.id = 1;
  ball.shape = Sphere{0.5};
  ball.start = ball.position = {0, 0, -0.25};
  ball.inverse_mass = 1 / mass;
  ball.velocity = velocity;
  return ball;
}

// --- One substep's hits ---

TEST(YieldingBall, AHitLeavesNodeAndBallWithTheirCommonVelocity) {
  // Perfectly plastic along the normal: (m1 v1 + m2 v2) / (m1 + m2), m1 = 1 kg; across it both go on.
  for (const double mass : kMasses) {
    Particles<double> sheet = test::flat_sheet<double>(9, 9, {8, 8});
    set(sheet.velocity, 4, 4, {3, 0, -4});
    std::vector<Solid> balls{ball_of(mass, {0, 1, 2})};
    test::LooseContact<double> contact(sheet.grid());
    ASSERT_EQ(contact.resolve(sheet, balls, {}), 1);
    const double common = (-4 + mass * 2) / (1 + mass);
    EXPECT_LT((sheet.velocity_at(4, 4) - Vec3(3, 0, common)).norm(), 1e-14) << mass;
    EXPECT_LT((balls[0].velocity - Vec3(0, 1, common)).norm(), 1e-14) << mass;
  }
}

TEST(YieldingBall, FrictionTakesItsPartOfTheNormalImpulse) {
  // Normal impulse J = 6 m1 m2 / (m1 + m2); along the surface 0.25 J, as 4 m/s need more to stop.
  for (const double mass : kMasses) {
    Particles<double> sheet = test::flat_sheet<double>(9, 9, {8, 8});
    set(sheet.velocity, 4, 4, {4, 0, -4});
    std::vector<Solid> balls{ball_of(mass, {0, 0, 2})};
    balls[0].friction = 0.25;
    test::LooseContact<double> contact(sheet.grid());
    ASSERT_EQ(contact.resolve(sheet, balls, {}), 1);
    const double impulse = 0.25 * 6 * mass / (1 + mass);
    EXPECT_NEAR(sheet.velocity_at(4, 4).x(), 4 - impulse, 1e-14) << mass;
    EXPECT_NEAR(balls[0].velocity.x(), impulse / mass, 1e-14) << mass;
  }
}

TEST(YieldingBall, AHundredHitsKeepTheMomentumAndAddNoEnergy) {
  for (const double mass : kMasses) {
    for (const double friction : {0.0, 0.3, 1e6}) {
      Particles<double> sheet = test::flat_sheet<double>(65, 65, {2, 2});
      test::share_mass(sheet, 1, Discretization::continuum);
      test::randomise(sheet.velocity, -3, 3, 2);
      std::vector<Solid> balls{ball_of(mass, {0, 1, 2})};
      balls[0].friction = friction;
      const auto momentum = [&] { return Vec3(linear_momentum(sheet) + mass * balls[0].velocity); };
      const auto energy = [&] { return kinetic_energy(sheet) + mass * balls[0].velocity.squaredNorm() / 2; };
      const Vec3 momentum_before = momentum();
      const double energy_before = energy();
      test::LooseContact<double> contact(sheet.grid());
      ASSERT_GT(contact.resolve(sheet, balls, {}), 100);
      EXPECT_LT((momentum() - momentum_before).norm(), 1e-12 * (1 + mass)) << mass;
      EXPECT_LT(energy(), energy_before) << mass;
    }
  }
}

// --- Whole steps ---

struct Fall {
  const char* name;
  IntegratorDescription integrator;
  double ball_mass;  ///< kg; the sheet's is 0.4
};
std::ostream& operator<<(std::ostream& out, const Fall& fall) { return out << fall.name; }

class SheetAndBall : public ::testing::TestWithParam<Fall> {
 protected:
  static SimulationDescription scene() {
    SimulationDescription made = test::hung_scene();
    made.cloths[0].perturbation = 0;
    made.effects.clear();
    made.integrator = GetParam().integrator;
    made.balls = {ball_at({0.1, -0.05, 0.35}, 0.3, {0, 0, -2})};
    made.balls[0].motion = BallDescription::Motion::dynamic;
    made.balls[0].mass = GetParam().ball_mass;
    return made;
  }
  static Vec3 momentum(const Simulation<double>& simulation) {
    return linear_momentum(simulation.cloths()[0].particles()) +
           GetParam().ball_mass * simulation.colliders().balls()[0].velocity;
  }
  static double energy(const Simulation<double>& simulation) {
    double sum = GetParam().ball_mass * simulation.colliders().balls()[0].velocity.squaredNorm() / 2;
    for (const Cloth<double>& cloth : simulation.cloths()) {
      sum += kinetic_energy(cloth.particles()) + cloth.springs().energy(cloth.particles().position);
    }
    return sum;
  }
};

TEST_P(SheetAndBall, GainNoEnergyWhenTheyHit) {
  // A free sheet and no gravity. Of the energy that of their common motion, P^2 / 2 (m1 + m2), is nothing
  // that can be gained or lost; the rest begins with that of a plastic hit, m1 m2 / (m1 + m2) v^2 / 2.
  SimulationDescription made = scene();
  made.cloths[0].pins.clear();
  Simulation<double> simulation(made);
  const double mass = GetParam().ball_mass, sheet = simulation.cloths()[0].total_mass();
  const auto inner = [&] {
    return energy(simulation) - momentum(simulation).squaredNorm() / (2 * (mass + sheet));
  };
  const double before = sheet * mass / (sheet + mass) * 2 * 2 / 2;
  EXPECT_NEAR(inner(), before, 1e-12);
  int contacts = 0;
  for (int step = 0; step < 120; ++step) {
    simulation.step();
    contacts += simulation.report(0).nodes_in_contact;
    ASSERT_LE(inner(), before * (1 + 1e-9)) << "step " << step;
  }
  EXPECT_GT(contacts, 0);
}

TEST_P(SheetAndBall, GainNoEnergyWhereTheSheetIsHeld) {
  SimulationDescription made = scene();
  made.cloths[0].pins = {{0, 1, 0, 0}, {0, 1, 1, 1}};
  Simulation<double> simulation(made);
  const double before = energy(simulation);
  for (int step = 0; step < 240; ++step) {
    simulation.step();
    ASSERT_LE(energy(simulation), before) << "step " << step;
  }
}

const Fall kFalls[] = {
    {"backward_euler_light", BackwardEulerDescription{}, 0.4e-3},
    {"backward_euler_even", BackwardEulerDescription{}, 0.4},
    {"backward_euler_heavy", BackwardEulerDescription{}, 400},
    {"bdf2_light", Bdf2Description{}, 0.4e-3},
    {"bdf2_even", Bdf2Description{}, 0.4},
    {"bdf2_heavy", Bdf2Description{}, 400},
};
INSTANTIATE_TEST_SUITE_P(Falls, SheetAndBall, ::testing::ValuesIn(kFalls),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace weft
