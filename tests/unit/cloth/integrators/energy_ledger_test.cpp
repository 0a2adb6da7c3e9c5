// The books of a cloth, entry by entry, without the solves whose losses they are about.
#include "cloth/integrators/energy_ledger.h"

#include <gtest/gtest.h>

#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::Rig;
using test::same_bits;
using test::set;

constexpr double kLedgerStep = test::kFrame;
/// What of a motion of some m/s is not given back as too slow: (0.02 g dt)^2 beside its speed squared.
constexpr double kTooSlow = 1e-5;

/// A sheet in motion, rumpled, which something drives in this way.
struct Booked {
  explicit Booked(Drive driven, double liveliness = 1, bool hung = false,
                  const std::vector<EffectDescription>& effects = {})
      : rig(hung ? test::hung_rig<double>(7, 9, BackwardEulerDescription{}, effects)
                 : test::sheet_rig<double>(7, 9, BackwardEulerDescription{}, effects)),
        ledger(liveliness),
        drive(driven) {
    VectorField<double> off(rig.particles.grid());
    test::randomise(off, -0.02, 0.02, 3);
    test::randomise(rig.particles.velocity, -3, 5, 4);
    each_node(rig.particles.grid(), [&](int r, int c) {
      const bool free = rig.particles.inverse_mass.at(r, c) != 0;
      set(rig.particles.position, r, c,
          rig.particles.local_position_at(r, c) + double(free) * test::get(off, r, c));
      if (!free) set(rig.particles.velocity, r, c, {0, 0, 0});
    });
  }
  Forces<double> forces() {
    Forces<double> all = rig.forces(0);
    all.drive = drive;
    return all;
  }
  void begin() { ledger.begin_step(rig.particles, forces(), 0); }
  double end(bool touched = false) {
    report = {};
    return ledger.end_step(rig.particles, forces(), kLedgerStep, touched, freedom(), report);
  }
  /// What the pushes leave it.
  Freedom freedom() const {
    return is_held(rig.particles) ? Freedom::none() : freedom_beside(pushes, rig.particles);
  }
  /// Of springs and motion beside the centre of mass, J.
  double inner_energy() const {
    return motion_energy(rig.particles).beside_centre + rig.sheet.energy(rig.particles.position);
  }
  /// What errors do to the motion.
  void scale(double factor) {
    each_node(rig.particles.grid(), [&](int r, int c) {
      set(rig.particles.velocity, r, c, factor * rig.particles.velocity_at(r, c));
    });
  }

  Rig<double> rig;
  EnergyLedger<double> ledger;
  Drive drive;
  std::vector<Push> pushes;
  AdvanceReport report;
};

TEST(EnergyLedger, WhatTheMotionLostIsGivenBack) {
  Booked cloth(Drive::nothing);
  const double before = cloth.inner_energy();
  cloth.begin();
  ASSERT_TRUE(cloth.ledger.counts());
  cloth.scale(0.95);
  const double lost = before - cloth.inner_energy();
  const Vec3 momentum = linear_momentum(cloth.rig.particles), spin = angular_momentum(cloth.rig.particles);
  const double scale = cloth.end();
  EXPECT_NEAR(cloth.report.energy_lost, lost, 1e-12 * before);
  EXPECT_NEAR(cloth.report.energy_given_back, lost, kTooSlow * lost);
  EXPECT_NEAR(cloth.inner_energy(), before, kTooSlow * lost);
  EXPECT_GT(scale, 1);
  // All inner motion is scaled alike: momenta stay.
  EXPECT_LT((linear_momentum(cloth.rig.particles) - momentum).norm(), 1e-13 * momentum.norm());
  EXPECT_LT((angular_momentum(cloth.rig.particles) - spin).norm(), 1e-13);
}

// In wind half of it.
TEST(EnergyLedger, InWindHalfOfWhatIsLostIsGivenBack) {
  Booked cloth(Drive::wind);
  cloth.begin();
  cloth.scale(0.95);
  cloth.end();
  EXPECT_GT(cloth.report.energy_lost, 0);
  EXPECT_NEAR(cloth.report.energy_given_back / cloth.report.energy_lost, 0.5, kTooSlow);
}

TEST(EnergyLedger, LivelinessIsTheShareThatIsGivenBack) {
  for (const double liveliness : {0.0, 0.25, 0.75}) {
    Booked cloth(Drive::nothing, liveliness);
    cloth.begin();
    cloth.scale(0.95);
    cloth.end();
    EXPECT_NEAR(cloth.report.energy_given_back / cloth.report.energy_lost, liveliness, kTooSlow);
  }
}

// With none of it, too.
TEST(EnergyLedger, WithoutADriveAClothNeverHasMoreThanItHad) {
  for (const double liveliness : {0.0, 1.0}) {
    Booked cloth(Drive::nothing, liveliness);
    const double before = cloth.inner_energy();
    for (int step = 0; step < 5; ++step) {
      cloth.begin();
      cloth.scale(1.05);
      cloth.end();
      EXPECT_LT(cloth.report.energy_lost, 0);
      EXPECT_NEAR(cloth.inner_energy(), before, 1e-12 * before);
    }
  }
}

// Errors alone would keep it going.
TEST(EnergyLedger, AMotionAsSlowAsWhatASolveLeavesGetsNothingBack) {
  Booked cloth(Drive::nothing);
  cloth.scale(1e-5);
  cloth.begin();
  cloth.scale(0.95);
  cloth.end();
  EXPECT_GT(cloth.report.energy_lost, 0);
  EXPECT_LT(cloth.report.energy_given_back, 1e-3 * cloth.report.energy_lost);
}

TEST(EnergyLedger, WhatHandsDriveHasNoBooks) {
  Booked cloth(Drive::other);
  cloth.begin();
  EXPECT_FALSE(cloth.ledger.counts());
  cloth.scale(0.5);
  const VectorField<double> velocity = cloth.rig.particles.velocity;
  EXPECT_EQ(cloth.end(), 1);
  EXPECT_TRUE(same_bits(cloth.rig.particles.velocity, velocity));
  EXPECT_EQ(cloth.report.energy_lost, 0);
}

// A torn cloth's pieces do not move as one.
TEST(EnergyLedger, ATornClothGetsNothingBack) {
  Booked cloth(Drive::nothing);
  const auto torn = std::make_shared<TornLinks>(cloth.rig.particles.grid());
  torn->cut({3, 4, true});
  cloth.rig.sheet = Sheet<double>(cloth.rig.cloth, SheetEffects(std::vector<EffectDescription>{}),
                                  cloth.rig.particles.inverse_mass, torn);
  cloth.begin();
  cloth.scale(0.95);
  cloth.end();
  EXPECT_EQ(cloth.report.energy_given_back, 0);
}

// Where the motion turns there is little to scale: what it lost then waits until there is more, but no more
// of it than what gravity gives in a step.
TEST(EnergyLedger, WhatCannotBeGivenBackIsOwedUpToWhatGravityGives) {
  Booked cloth(Drive::nothing);
  cloth.begin();
  cloth.end();  // as it has moved of late
  cloth.begin();
  cloth.scale(0.1);
  cloth.end();
  const double speed = 9.81 * kLedgerStep, most = total_mass(cloth.rig.particles) * speed * speed / 2;
  EXPECT_GT(cloth.report.energy_lost - cloth.report.energy_given_back, 10 * most);
  // Contact gives it a motion, which it had not lost; what it is owed comes with that.
  cloth.begin();
  const double before = cloth.inner_energy();
  cloth.scale(3);
  cloth.ledger.count_contact({before - cloth.inner_energy(), 0});
  cloth.end();
  EXPECT_NEAR(cloth.report.energy_lost, 0, 1e-12 * before);
  EXPECT_NEAR(cloth.report.energy_given_back, most, 0.01 * most);
}

/// A way of the free nodes, random within 0.1 m.
void go_on(Particles<double>& particles) {
  VectorField<double> way(particles.grid());
  test::randomise(way, -0.1, 0.1, 9);
  each_node(particles.grid(), [&](int r, int c) {
    if (particles.inverse_mass.at(r, c) == 0) return;
    set(particles.position, r, c, particles.local_position_at(r, c) + test::get(way, r, c));
  });
}

/// Of weights on these ways, J.
double weights_work(const Particles<double>& particles, const VectorField<double>& start) {
  double sum = 0;
  each_node(particles.grid(), [&](int r, int c) {
    const Vec3 way = particles.local_position_at(r, c) - test::get(start, r, c);
    sum += particles.mass.at(r, c) * standard_gravity().dot(way);
  });
  return sum;
}

// What a held cloth had, and the work of weights, less what contact took and what it has: the books balance.
TEST(EnergyLedger, WhatIsLostIsWhatTheBooksDoNotExplain) {
  Booked cloth(Drive::nothing, 1, true, {GravityEffect{}});
  const double before = cloth.inner_energy();
  cloth.begin();
  const VectorField<double> start = cloth.rig.particles.position, was = cloth.rig.particles.velocity;
  go_on(cloth.rig.particles);
  cloth.scale(0.5);
  cloth.ledger.count_work(cloth.rig.particles, cloth.forces(), {start, was, nullptr, nullptr, kLedgerStep});
  cloth.ledger.count_contact({0.25, 0});
  const double work = weights_work(cloth.rig.particles, start), after = cloth.inner_energy();
  cloth.end();
  EXPECT_NE(work, 0);
  EXPECT_NEAR(cloth.report.effects_work, work, 1e-12 * before);
  EXPECT_EQ(cloth.report.contact_took, 0.25);
  EXPECT_NEAR(cloth.report.energy_lost, before + work - 0.25 - after, 1e-11 * before);
}

// The weights' work is on the centre of mass alone, and of a cloth that nothing holds or touches that is
// none.
TEST(EnergyLedger, AFallIsNoneOfTheInnerMotion) {
  Booked free(Drive::nothing, 1, false, {GravityEffect{}}),
      leans(Drive::nothing, 1, false, {GravityEffect{}});
  for (Booked* cloth : {&free, &leans}) {
    cloth->begin();
    const VectorField<double> start = cloth->rig.particles.position, was = cloth->rig.particles.velocity;
    go_on(cloth->rig.particles);
    cloth->ledger.count_work(cloth->rig.particles, cloth->forces(),
                             {start, was, nullptr, nullptr, kLedgerStep});
    const double work = weights_work(cloth->rig.particles, start);
    const bool touched = cloth == &leans;
    cloth->end(touched);
    EXPECT_GT(std::abs(work), 1e-3);
    EXPECT_NEAR(cloth->report.effects_work, touched ? work : 0, 1e-14);
  }
}

// Places that run ahead by so many seconds count where they were then.
TEST(EnergyLedger, WorkIsCountedWhereTheNodesWereBeforeTheirLead) {
  Booked cloth(Drive::nothing, 1, true, {GravityEffect{}});
  cloth.begin();
  Particles<double>& particles = cloth.rig.particles;
  const VectorField<double> start = particles.position, was = particles.velocity;
  Field<double> lead(particles.grid());
  lead.fill(0.01);
  double less = 0;
  each_node(particles.grid(), [&](int r, int c) {
    if (particles.inverse_mass.at(r, c) == 0) return;
    const Vec3 gain(0.1, -0.3, 0);
    set(particles.velocity, r, c, particles.velocity_at(r, c) + gain);
    less += particles.mass.at(r, c) * standard_gravity().dot(0.01 * gain);
  });
  cloth.ledger.count_work(particles, cloth.forces(), {start, was, nullptr, &lead, kLedgerStep});
  cloth.end();
  EXPECT_NEAR(cloth.report.effects_work, -less, 1e-15);
}

// What disturbed it begins the books anew.
TEST(EnergyLedger, ADisturbanceIsNoLoss) {
  Booked cloth(Drive::nothing);
  cloth.begin();
  cloth.end();
  cloth.scale(0.5);
  Forces<double> forces = cloth.forces();
  forces.disturbed = true;
  cloth.ledger.begin_step(cloth.rig.particles, forces, 0);
  const double before = cloth.inner_energy();
  cloth.end();
  EXPECT_NEAR(cloth.report.energy_lost, 0, 1e-12 * before);
}

}  // namespace
}  // namespace weft
