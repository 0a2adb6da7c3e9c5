// Eqs. 2, 3 and 4, and their sum with the springs, Eq. 5.
#include <gtest/gtest.h>

#include <numbers>

#include "cloth/forces/damping.h"
#include "cloth/forces/gravity.h"
#include "cloth/forces/paper_wind.h"
#include "cloth/integrators/integrator.h"
#include "effect_sheet.h"

namespace weft {
namespace {

using test::area_share;
using test::each_node;
using test::EffectSheet;
using test::get;
using test::kBoth;
using test::set;
using test::tilt;
using test::total;

// --- Eq. 2 ---

TEST(Gravity, IsMassTimesAccelerationOnEveryNode) {
  for (Discretization d : kBoth) {
    const EffectSheet sheet(d);
    const VectorField<double> force = sheet.forces(Gravity<double>({{0.5, -9.81, 2.0}}));
    each_node(force.grid(), [&](int r, int c) {
      EXPECT_LT((get(force, r, c) - sheet.particles.mass.at(r, c) * Vec3(0.5, -9.81, 2.0)).norm(), 1e-15);
    });
    EXPECT_NEAR(total(force).y(), 0.2 * -9.81, 1e-13);
  }
}

TEST(Gravity, AHeldNodeKeepsItsWeight) {
  // A pin's inverse mass is 0, its mass is not: Eq. 9 counts every particle. (Nothing moves it all the same.)
  EffectSheet sheet(Discretization::paper);
  sheet.particles.inverse_mass.at(0, 0) = 0;
  EXPECT_NEAR(get(sheet.forces(Gravity<double>({})), 0, 0).y(), 0.2 / 45 * -9.81, 1e-15);
}

TEST(Gravity, OfASceneIsTheSumOfItsGravityEffects) {
  EXPECT_EQ(total_gravity({}), Vec3(0, 0, 0));
  EXPECT_EQ(total_gravity({GravityEffect{}}), Vec3(0, -9.81, 0));
  EXPECT_EQ(total_gravity({GravityEffect{{0, -1, 0}}, DampingEffect{}, GravityEffect{{2, 0, 0.5}}}),
            Vec3(2, -1, 0.5));
}

// --- Eq. 3 ---

TEST(Damping, IsMinusKTimesVelocityPerParticleForThePaper) {
  EffectSheet sheet(Discretization::paper);
  sheet.cloth.material.damping = 20;  // Table 1
  set(sheet.particles.velocity, 2, 3, {1, -2, 0.5});
  const VectorField<double> force = sheet.forces(Damping<double>({}));
  EXPECT_LT((get(force, 2, 3) - Vec3(-20, 40, -10)).norm(), 1e-12);
  EXPECT_EQ(get(force, 0, 0), Vec3(0, 0, 0));
}

TEST(Damping, IsPerAreaForTheContinuum) {
  // 3 N s/m3 on cells of 1/16 m2; the whole sheet of 2 m2 at 1.5 m/s feels 3 * 2 * 1.5 = 9 N.
  EffectSheet sheet(Discretization::continuum);
  sheet.cloth.material.damping = 3;
  each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, {0, 0, 1.5}); });
  const VectorField<double> force = sheet.forces(Damping<double>({}));
  each_node(force.grid(), [&](int r, int c) {
    EXPECT_NEAR(get(force, r, c).z(), -3 * 1.5 / 16 * area_share(force.grid(), r, c), 1e-14);
  });
  EXPECT_NEAR(total(force).z(), -9, 1e-12);
}

TEST(Damping, RateIsKOverMass) {
  // Paper: k / (M/n) = 20 * 45 / 0.2. Continuum: per area over density, 3 / 0.1.
  EffectSheet paper(Discretization::paper), continuum(Discretization::continuum);
  paper.cloth.material.damping = 20;
  continuum.cloth.material.damping = 3;
  EXPECT_NEAR(Damping<double>({}).max_damping_rate(paper.particles, paper.context()), 4500, 1e-8);
  EXPECT_NEAR(Damping<double>({}).max_damping_rate(continuum.particles, continuum.context()), 30, 1e-11);
}

// --- Eq. 4 ---

TEST(PaperWind, IsLambdaTimesTheWindsDirectionOnEveryParticle) {
  // Table 1: lambda = 1; at 1 m/s the force is Eq. 4 as printed, 1 N on each particle.
  EffectSheet sheet(Discretization::paper);
  sheet.wind = {Vec3(3, 0, -4) / 5, 1.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({1.0, false}));
  each_node(force.grid(),
            [&](int r, int c) { EXPECT_LT((get(force, r, c) - Vec3(0.6, 0, -0.8)).norm(), 1e-15); });
}

TEST(PaperWind, GrowsLinearlyWithSpeedAndFactor) {
  EffectSheet sheet(Discretization::paper);
  sheet.wind = {{1, 0, 0}, 2.5};
  EXPECT_NEAR(get(sheet.forces(PaperWind<double>({0.2, false})), 1, 1).x(), 0.5, 1e-15);
  sheet.wind.speed = 0;
  EXPECT_EQ(total(sheet.forces(PaperWind<double>({0.2, false}))), Vec3(0, 0, 0));
}

TEST(PaperWind, IsPerAreaForTheContinuum) {
  // 0.5 N/m2 at 3 m/s on 2 m2: 3 N in all, by the area each node represents.
  EffectSheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, 1}, 3.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({0.5, false}));
  each_node(force.grid(), [&](int r, int c) {
    EXPECT_NEAR(get(force, r, c).z(), 1.5 / 16 * area_share(force.grid(), r, c), 1e-15);
  });
  EXPECT_NEAR(total(force).z(), 3, 1e-13);
}

TEST(PaperWind, AlongTheClothsNormalPointsDownwind) {
  // The other reading of "unit normal vector": a sheet tilted by 60 degrees is pushed along its own normal
  // with the same lambda, to the side the wind goes, whichever way the wind comes.
  for (double direction : {1.0, -1.0}) {
    EffectSheet sheet(Discretization::paper);
    tilt(sheet.particles, std::numbers::pi / 3);
    sheet.wind = {{0, 0, direction}, 1.0};
    const VectorField<double> force = sheet.forces(PaperWind<double>({2.0, true}));
    const Vec3 expected = direction * 2.0 * Vec3(0, -std::sqrt(0.75), 0.5);
    each_node(force.grid(), [&](int r, int c) { EXPECT_LT((get(force, r, c) - expected).norm(), 1e-13); });
  }
}

TEST(PaperWind, AlongTheNormalIsPerAreaForTheContinuum) {
  EffectSheet sheet(Discretization::continuum);
  tilt(sheet.particles, std::numbers::pi / 3);
  sheet.wind = {{0, 0, -1}, 3.0};
  // lambda * speed * area = 0.5 * 3 * 2 = 3 N along (0, sin60, -cos60).
  EXPECT_LT(
      (total(sheet.forces(PaperWind<double>({0.5, true}))) - 3.0 * Vec3(0, std::sqrt(0.75), -0.5)).norm(),
      1e-12);
}

TEST(PaperWind, ACrumpledPointHasNoNormalAndStaysFinite) {
  EffectSheet sheet(Discretization::paper);
  sheet.particles.position.fill(0);
  sheet.wind = {{0, 0, -1}, 1.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({1.0, true}));
  each_node(force.grid(), [&](int r, int c) { EXPECT_TRUE(get(force, r, c).allFinite()); });
}

// --- Composition, Eq. 5 ---

TEST(Effects, OnlyThoseListedAreMade) {
  EXPECT_TRUE(make_effects<float>({}).empty());
  const auto effects =
      make_effects<float>({PaperWindEffect{}, GravityEffect{}, AerodynamicsEffect{}, DampingEffect{}});
  ASSERT_EQ(effects.size(), 4u);
  EXPECT_STREQ(effects[0]->name(), "paper_wind");
  EXPECT_STREQ(effects[1]->name(), "gravity");
  EXPECT_STREQ(effects[2]->name(), "aerodynamics");
  EXPECT_STREQ(effects[3]->name(), "damping");
}

TEST(Effects, ForcesWithoutVelocityHaveNoDampingRate) {
  const EffectSheet sheet(Discretization::paper);
  for (const auto& effect : make_effects<double>({GravityEffect{}, PaperWindEffect{}})) {
    EXPECT_EQ(effect->max_damping_rate(sheet.particles, sheet.context()), 0.0) << effect->name();
  }
}

TEST(Equation5, TheResultantIsTheSumOfElasticGravityResistanceAndWind) {
  EffectSheet sheet(Discretization::paper);
  sheet.cloth.material.damping = 2;
  sheet.wind = {{0, 0, -1}, 1.5};
  test::randomise(sheet.particles.position, -1, 1, 1);
  test::randomise(sheet.particles.velocity, -1, 1, 2);
  const Springs<double> springs(sheet.cloth.material, Discretization::paper, {2, 1}, sheet.particles.grid());
  const auto effects = make_effects<double>({GravityEffect{}, DampingEffect{}, PaperWindEffect{}});
  VectorField<double> elastic(sheet.particles.grid()), sum(sheet.particles.grid());
  springs.add_forces(sheet.particles.position, elastic);
  sum.fill(123.0);  // whatever was there is overwritten
  const Sheet<double> resisting(springs);
  Forces<double>{&resisting, &effects, sheet.context()}.sum(sheet.particles, sum);
  each_node(sum.grid(), [&](int r, int c) {
    const Vec3 gravity = 0.2 / 45 * Vec3(0, -9.81, 0);
    const Vec3 resist = -2 * sheet.particles.velocity_at(r, c);
    const Vec3 wind(0, 0, -1.5);
    // Elastic forces reach 1e4 N, so the sum is good to about 1e-11.
    EXPECT_LT((get(sum, r, c) - (get(elastic, r, c) + gravity + resist + wind)).norm(), 1e-10);
  });
}

}  // namespace
}  // namespace weft
