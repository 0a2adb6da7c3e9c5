#include "cloth/integrators/forces.h"

#include <gtest/gtest.h>

#include "cloth/sheet/diagnostics.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;

/// Gives every node this force, and has this damping rate, tension and energy.
class ConstantEffect : public Effect<double> {
 public:
  ConstantEffect(const Vec3& force, bool slow) : force_(force), slow_(slow) {}
  const char* name() const override { return "constant"; }
  void add_forces(const Particles<double>& particles, const EffectContext&,
                  VectorField<double>& force) const override {
    each_node(particles.grid(), [&](int r, int c) { test::set(force, r, c, get(force, r, c) + force_); });
  }
  double max_damping_rate(const Particles<double>&, const EffectContext&) const override {
    return force_.norm();
  }
  double tension(const Particles<double>&, const EffectContext&) const override { return 10 * force_.norm(); }
  bool slow() const override { return slow_; }
  double energy(const Particles<double>&) const override { return 100 * force_.norm(); }

 private:
  Vec3 force_;
  bool slow_;
};

const Vec3 kSlowForce(0, 2, 0), kQuickForce(0, 0, 3), kOtherForce(1, 0, 0);

/// A rumpled sheet on which one slow effect and two others act.
struct Pushed {
  Pushed() : rig(test::sheet_rig<double>(5, 6, SymplecticEulerDescription{})), springs(rig.particles.grid()) {
    VectorField<double> off(springs.grid());
    test::randomise(off, -0.05, 0.05, 1);
    test::randomise(rig.particles.velocity, -1, 1, 2);
    each_node(springs.grid(), [&](int r, int c) {
      test::set(rig.particles.position, r, c, rig.particles.local_position_at(r, c) + get(off, r, c));
    });
    rig.effects.push_back(std::make_unique<ConstantEffect>(kSlowForce, true));
    rig.effects.push_back(std::make_unique<ConstantEffect>(kQuickForce, false));
    rig.effects.push_back(std::make_unique<ConstantEffect>(kOtherForce, false));
    rig.sheet.add_forces(rig.particles.position, springs);
    forces = rig.forces(0);
  }
  /// What was summed is the springs' force, or none, and these effects'.
  void expect_sum(const VectorField<double>& found, double of_springs, const Vec3& of_effects) const {
    each_node(springs.grid(), [&](int r, int c) {
      const Vec3 expected = of_springs * get(springs, r, c) + of_effects;
      EXPECT_LT((get(found, r, c) - expected).norm(), 1e-11);
    });
  }
  test::Rig<double> rig;
  Forces<double> forces;
  VectorField<double> springs;
};

// Whatever was in the field before.
TEST(Forces, SumsAreOfSheetAndEffects) {
  const Pushed cloth;
  VectorField<double> sum(cloth.springs.grid());
  sum.fill(77);
  cloth.forces.sum(cloth.rig.particles, sum);
  cloth.expect_sum(sum, 1, kSlowForce + kQuickForce + kOtherForce);
  cloth.forces.sum_effects(cloth.rig.particles, sum);
  cloth.expect_sum(sum, 0, kSlowForce + kQuickForce + kOtherForce);
  cloth.forces.sum_effects(cloth.rig.particles, sum, cloth.rig.effects[1].get());
  cloth.expect_sum(sum, 0, kSlowForce + kOtherForce);
}

// What is slow is found apart, and what was found of it is taken instead of it.
TEST(Forces, SlowEffectsMayBeTakenFromBefore) {
  const Pushed cloth;
  VectorField<double> sum(cloth.springs.grid()), slow(cloth.springs.grid());
  slow.fill(77);
  cloth.forces.sum_slow(cloth.rig.particles, slow);
  cloth.expect_sum(slow, 0, kSlowForce);
  EXPECT_TRUE(cloth.forces.any_slow());
  slow.fill(5);
  cloth.forces.sum_with(slow, cloth.rig.particles, sum);
  cloth.expect_sum(sum, 1, Vec3(5, 5, 5) + kQuickForce + kOtherForce);
}

TEST(Forces, BoundsAreTheSumsOfTheEffects) {
  const Pushed cloth;
  const DampingRates all = cloth.forces.max_damping_rates(cloth.rig.particles),
                     but_one =
                         cloth.forces.max_damping_rates(cloth.rig.particles, cloth.rig.effects[1].get());
  EXPECT_EQ(all.slow, 2);
  EXPECT_EQ(all.other, 4);
  EXPECT_EQ(all.sum(), 6);
  EXPECT_EQ(but_one.slow, 2);
  EXPECT_EQ(but_one.other, 1);
  EXPECT_EQ(cloth.forces.tension(cloth.rig.particles), 60);
}

TEST(Forces, EnergyIsOfMotionSheetAndEffects) {
  const Pushed cloth;
  const double sheet = cloth.rig.sheet.energy(cloth.rig.particles.position),
               motion = kinetic_energy(cloth.rig.particles);
  EXPECT_GT(sheet, 0);
  EXPECT_GT(motion, 0);
  EXPECT_EQ(cloth.forces.effects_energy(cloth.rig.particles), 600);
  EXPECT_NEAR(cloth.forces.energy(cloth.rig.particles), sheet + motion + 600, 1e-12 * (sheet + motion + 600));
}

// The sum is minus the gradient of the energy: by central differences, of every node and axis.
TEST(Forces, SumsAreTheGradientOfTheEnergy) {
  test::Rig<double> rig = test::sheet_rig<double>(4, 5, SymplecticEulerDescription{}, {GravityEffect{}});
  VectorField<double> off(rig.particles.grid()), sum(rig.particles.grid());
  test::randomise(off, -0.05, 0.05, 1);
  each_node(sum.grid(), [&](int r, int c) {
    test::set(rig.particles.position, r, c, rig.particles.local_position_at(r, c) + get(off, r, c));
  });
  const Forces<double> forces = rig.forces(0);
  forces.sum(rig.particles, sum);
  constexpr double kNudge = 1e-6;
  each_node(sum.grid(), [&](int r, int c) {
    for (Field<double> VectorField<double>::*axis :
         {&VectorField<double>::x, &VectorField<double>::y, &VectorField<double>::z}) {
      double& place = (rig.particles.position.*axis).at(r, c);
      const double middle = place;
      place = middle + kNudge;
      const double above = forces.energy(rig.particles);
      place = middle - kNudge;
      const double below = forces.energy(rig.particles);
      place = middle;
      EXPECT_NEAR((sum.*axis).at(r, c), (below - above) / (2 * kNudge), 1e-5);
    }
  });
}

// Without pins or a bag there is nothing to carry, join or close.
TEST(Forces, WithoutPinsAndBagNothingMoves) {
  Pushed cloth;
  const Particles<double> before = cloth.rig.particles;
  cloth.forces.carry_pins(cloth.rig.particles, 1);
  cloth.forces.join(cloth.rig.particles);
  cloth.forces.close(cloth.rig.particles, 1, 0.1);
  cloth.forces.for_each_pin_way(0, 1, [](auto&&...) { ADD_FAILURE(); });
  EXPECT_TRUE(test::same_state(cloth.rig.particles, before));
  EXPECT_FALSE(cloth.forces.holds_gas());
}

}  // namespace
}  // namespace weft
