#include "cloth/integrators/energy_bound.h"

#include <gtest/gtest.h>

#include "cloth/sheet/diagnostics.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::same_bits;
using test::set;

/// A hung sheet in motion under gravity, not driven unless told.
struct Bounded {
  Bounded() : rig(test::hung_rig<double>(6, 8, SymplecticEulerDescription{}, {GravityEffect{}})) {
    test::randomise(rig.particles.velocity, -2, 3, 2);
    for (const int c : {0, 7}) set(rig.particles.velocity, 0, c, {0, 0, 0});
  }
  Forces<double> forces() {
    Forces<double> all = rig.forces(0);
    all.drive = drive;
    all.disturbed = disturbed;
    return all;
  }
  void begin() { bound.begin_step(rig.particles, forces(), h); }
  double end(double dt = test::kFrame) { return bound.end_step(rig.particles, forces(), h, dt); }
  double energy() { return forces().energy(rig.particles); }
  void scale(double factor) {
    each_node(rig.particles.grid(), [&](int r, int c) {
      set(rig.particles.velocity, r, c, factor * rig.particles.velocity_at(r, c));
    });
  }

  test::Rig<double> rig;
  EnergyBound<double> bound;
  Drive drive = Drive::nothing;
  bool disturbed = false;
  double h = 0;  ///< s, a substep
};

// All velocities scaled alike, by the root of what is left of their energy.
TEST(EnergyBound, WhatErrorsGaveIsTakenFromTheMotion) {
  Bounded cloth;
  const double before = cloth.energy();
  cloth.begin();
  cloth.scale(1.1);
  EXPECT_NEAR(cloth.end(), 1 / 1.1, 1e-12);
  EXPECT_NEAR(cloth.energy(), before, 1e-12 * kinetic_energy(cloth.rig.particles));
}

// Height and springs count, too: a sheet that has sunk may move faster by as much.
TEST(EnergyBound, HeightThatTurnedIntoMotionIsNoError) {
  Bounded cloth;
  cloth.begin();
  const double height = cloth.forces().effects_energy(cloth.rig.particles),
               springs = cloth.rig.sheet.energy(cloth.rig.particles.position);
  each_node(cloth.rig.particles.grid(), [&](int r, int c) {
    if (cloth.rig.particles.inverse_mass.at(r, c) == 0) return;
    set(cloth.rig.particles.position, r, c,
        cloth.rig.particles.local_position_at(r, c) + Vec3(0, -1e-4 * r, 0));
  });
  const double free = height - cloth.forces().effects_energy(cloth.rig.particles) + springs -
                      cloth.rig.sheet.energy(cloth.rig.particles.position);
  ASSERT_GT(free, 0);
  const double kinetic = kinetic_energy(cloth.rig.particles);
  cloth.scale(std::sqrt(1 + 0.9 * free / kinetic));
  EXPECT_EQ(cloth.end(), 1);
  cloth.scale(std::sqrt((kinetic + 2 * free) / (kinetic + 0.9 * free)));
  EXPECT_LT(cloth.end(), 1);
  EXPECT_NEAR(kinetic_energy(cloth.rig.particles), kinetic + free, 1e-12 * kinetic);
}

// Velocities are those of half a substep before: the motion that counts, and is scaled, is that of now.
TEST(EnergyBound, OfLeapfrogItIsTheMotionWhenTheNodesAreWhereTheyAre) {
  Bounded cloth;
  cloth.h = 1e-2;
  const auto forward = [&](double seconds) {
    VectorField<double> force(cloth.rig.particles.grid());
    cloth.forces().sum(cloth.rig.particles, force);
    each_node(cloth.rig.particles.grid(), [&](int r, int c) {
      const double by = seconds * cloth.rig.particles.inverse_mass.at(r, c);
      set(cloth.rig.particles.velocity, r, c,
          cloth.rig.particles.velocity_at(r, c) +
              by * Vec3(force.x.at(r, c), force.y.at(r, c), force.z.at(r, c)));
    });
  };
  forward(cloth.h / 2);
  const double kinetic = kinetic_energy(cloth.rig.particles);
  forward(-cloth.h / 2);
  ASSERT_GT(std::abs(kinetic_energy(cloth.rig.particles) - kinetic), 1e-3 * kinetic);
  cloth.begin();
  forward(cloth.h / 2);
  cloth.scale(1.1);
  forward(-cloth.h / 2);
  EXPECT_NEAR(cloth.end(), 1 / 1.1, 1e-9);
  forward(cloth.h / 2);
  EXPECT_NEAR(kinetic_energy(cloth.rig.particles), kinetic, 1e-9 * kinetic);
}

// The bound is what it had when nothing drove it any more, not what it has had least.
TEST(EnergyBound, BelowItEnergyComesAndGoes) {
  Bounded cloth;
  cloth.begin();
  cloth.scale(0.98);
  EXPECT_EQ(cloth.end(), 1);
  cloth.begin();
  cloth.scale(1 / 0.985);
  const VectorField<double> velocity = cloth.rig.particles.velocity;
  EXPECT_EQ(cloth.end(), 1);
  EXPECT_TRUE(same_bits(cloth.rig.particles.velocity, velocity));
}

TEST(EnergyBound, WhatIsDrivenHasNone) {
  for (const Drive drive : {Drive::wind, Drive::other}) {
    Bounded cloth;
    cloth.drive = drive;
    cloth.begin();
    cloth.scale(1.1);
    EXPECT_EQ(cloth.end(), 1);
  }
}

TEST(EnergyBound, ADisturbanceBeginsItAnew) {
  Bounded cloth;
  cloth.begin();
  cloth.end();
  cloth.scale(2);
  cloth.disturbed = true;
  cloth.begin();
  EXPECT_EQ(cloth.end(), 1);
}

// Far below the bound the energy is seen ten times a second: what comes up to it meanwhile is taken then.
TEST(EnergyBound, FarBelowItTheEnergyIsSeenTenTimesASecond) {
  Bounded cloth;
  const double before = cloth.energy();
  cloth.begin();
  cloth.end(0.01);  // as fast as it has been
  cloth.begin();
  cloth.scale(0.5);
  cloth.end(0.01);
  cloth.scale(2 * 1.1);
  for (int step = 0; step < 9; ++step) {
    cloth.begin();
    EXPECT_EQ(cloth.end(0.01), 1) << step;
  }
  cloth.begin();
  cloth.end(0.0101);
  EXPECT_NEAR(cloth.energy(), before, 1e-12 * kinetic_energy(cloth.rig.particles));
}

}  // namespace
}  // namespace weft
