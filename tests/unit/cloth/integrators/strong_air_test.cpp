// How many parts an implicit step has in strong air.
#include "cloth/integrators/strong_air.h"

#include <gtest/gtest.h>

#include "rig.h"

namespace weft {
namespace {

/// Of a substep of `h` seconds of a sheet at rest across a wind, with that effect.
int parts_across(double speed, const EffectDescription& effect, double h) {
  const test::Rig<double> rig = test::sheet_rig<double>(9, 9, Bdf2Description{}, {effect});
  Forces<double> forces = rig.forces(0);
  Wind wind;
  wind.direction = Vec3::UnitZ();
  wind.speed = speed;
  forces.context.wind = &wind;
  return parts_in_strong_air(rig.particles, forces, h);
}

// Of a plate across the wind -dF/dv / m is rho C w / sigma: its inner nodes' quarters of four faces.
TEST(StrongAir, IsStrongByItsDampingRate) {
  const AerodynamicsEffect air;
  const double rate = air.air_density * air.drag * 30 / 0.1;  // 0.4 kg on 4 m2
  EXPECT_EQ(parts_across(30, air, 3.9 / rate), 1);
  EXPECT_EQ(parts_across(30, air, 4.1 / rate), 2);
  EXPECT_EQ(parts_across(30, air, 39 / rate), 10);
  EXPECT_EQ(parts_across(60, air, 39 / rate), 20);
}

// Drag k (w - v)^2 on each node has it at w x / (1 + x) after x = k w t from rest; its rate at rest is 2 k w.
TEST(StrongAir, TakesASheetAlongAsDragByTheSquareDoes) {
  const AerodynamicsEffect air;
  const test::Rig<double> rig = test::sheet_rig<double>(9, 9, Bdf2Description{}, {air});
  Forces<double> forces = rig.forces(0);
  Wind wind;
  wind.direction = Vec3::UnitZ();
  wind.speed = 30;
  forces.context.wind = &wind;
  const double rate = air.air_density * air.drag * wind.speed / 0.1;
  VectorField<double> velocity;
  for (const double dt : {0.1 / rate, 2 / rate, 50 / rate}) {
    find_velocity_in_air(rig.particles, forces, dt, velocity);
    const double x = rate * dt / 2;
    EXPECT_NEAR(velocity.z.at(4, 4), 30 * x / (1 + x), 1e-9) << dt;
    EXPECT_NEAR(velocity.x.at(4, 4), 0, 1e-12);
  }
}

TEST(StrongAir, HasSixtyFourPartsAtMost) { EXPECT_EQ(parts_across(100, AerodynamicsEffect{}, 100), 64); }

TEST(StrongAir, IsNoneWithoutAnEffectThatFeelsIt) { EXPECT_EQ(parts_across(100, DampingEffect{}, 100), 1); }

}  // namespace
}  // namespace weft
