// Eqs. 2, 3 and 4, the pressure of moving air, and their sum with the springs, Eq. 5.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "cloth/diagnostics.h"
#include "cloth/effects/aerodynamics.h"
#include "cloth/effects/damping.h"
#include "cloth/effects/gravity.h"
#include "cloth/effects/paper_wind.h"
#include "cloth/integrators/integrator.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

/// A 2 m x 1 m sheet of 0.1 kg/m2 on 5 x 9 nodes (cells of 0.25 m) and what an effect may read about it.
struct Sheet {
  ClothDescription cloth;
  Wind wind;
  Particles<double> particles;

  explicit Sheet(Discretization discretization) : particles(test::flat_sheet<double>(5, 9, {2, 1})) {
    cloth.size = {2, 1};
    cloth.discretization = discretization;
    cloth.material.density = 0.1;
    test::share_mass(particles, 0.2, discretization);
  }
  EffectContext context() const { return {&cloth, &wind, 0.0}; }
  VectorField<double> forces(const Effect<double>& effect) const {
    VectorField<double> force(particles.grid());
    effect.add_forces(particles, context(), force);
    return force;
  }
};

Vec3 total(const VectorField<double>& force) {
  Vec3 sum = Vec3::Zero();
  each_node(force.grid(), [&](int r, int c) { sum += get(force, r, c); });
  return sum;
}

/// Share of a cell's area that node (r, c) represents: 1 inside, 1/2 on an edge, 1/4 in a corner.
double area_share(const Grid& grid, int r, int c) {
  return (r == 0 || r == grid.rows - 1 ? 0.5 : 1.0) * (c == 0 || c == grid.cols - 1 ? 0.5 : 1.0);
}

constexpr Discretization kBoth[] = {Discretization::paper, Discretization::continuum};

// --- Eq. 2 ---

TEST(Gravity, IsMassTimesAccelerationOnEveryNode) {
  for (Discretization d : kBoth) {
    const Sheet sheet(d);
    const VectorField<double> force = sheet.forces(Gravity<double>({{0.5, -9.81, 2.0}}));
    each_node(force.grid(), [&](int r, int c) {
      EXPECT_LT((get(force, r, c) - sheet.particles.mass.at(r, c) * Vec3(0.5, -9.81, 2.0)).norm(), 1e-15);
    });
    EXPECT_NEAR(total(force).y(), 0.2 * -9.81, 1e-13);
  }
}

TEST(Gravity, AHeldNodeKeepsItsWeight) {
  // A pin's inverse mass is 0, its mass is not: Eq. 9 counts every particle. (Nothing moves it all the same.)
  Sheet sheet(Discretization::paper);
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
  Sheet sheet(Discretization::paper);
  sheet.cloth.material.damping = 20;  // Table 1
  set(sheet.particles.velocity, 2, 3, {1, -2, 0.5});
  const VectorField<double> force = sheet.forces(Damping<double>({}));
  EXPECT_LT((get(force, 2, 3) - Vec3(-20, 40, -10)).norm(), 1e-12);
  EXPECT_EQ(get(force, 0, 0), Vec3(0, 0, 0));
}

TEST(Damping, IsPerAreaForTheContinuum) {
  // 3 N s/m3 on cells of 1/16 m2; the whole sheet of 2 m2 at 1.5 m/s feels 3 * 2 * 1.5 = 9 N.
  Sheet sheet(Discretization::continuum);
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
  Sheet paper(Discretization::paper), continuum(Discretization::continuum);
  paper.cloth.material.damping = 20;
  continuum.cloth.material.damping = 3;
  EXPECT_NEAR(Damping<double>({}).max_damping_rate(paper.particles, paper.context()), 4500, 1e-8);
  EXPECT_NEAR(Damping<double>({}).max_damping_rate(continuum.particles, continuum.context()), 30, 1e-11);
}

// --- Eq. 4 ---

TEST(PaperWind, IsLambdaTimesTheWindsDirectionOnEveryParticle) {
  // Table 1: lambda = 1; at 1 m/s the force is Eq. 4 as printed, 1 N on each particle.
  Sheet sheet(Discretization::paper);
  sheet.wind = {Vec3(3, 0, -4) / 5, 1.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({1.0, false}));
  each_node(force.grid(),
            [&](int r, int c) { EXPECT_LT((get(force, r, c) - Vec3(0.6, 0, -0.8)).norm(), 1e-15); });
}

TEST(PaperWind, GrowsLinearlyWithSpeedAndFactor) {
  Sheet sheet(Discretization::paper);
  sheet.wind = {{1, 0, 0}, 2.5};
  EXPECT_NEAR(get(sheet.forces(PaperWind<double>({0.2, false})), 1, 1).x(), 0.5, 1e-15);
  sheet.wind.speed = 0;
  EXPECT_EQ(total(sheet.forces(PaperWind<double>({0.2, false}))), Vec3(0, 0, 0));
}

TEST(PaperWind, IsPerAreaForTheContinuum) {
  // 0.5 N/m2 at 3 m/s on 2 m2: 3 N in all, by the area each node represents.
  Sheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, 1}, 3.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({0.5, false}));
  each_node(force.grid(), [&](int r, int c) {
    EXPECT_NEAR(get(force, r, c).z(), 1.5 / 16 * area_share(force.grid(), r, c), 1e-15);
  });
  EXPECT_NEAR(total(force).z(), 3, 1e-13);
}

/// Turns the sheet about the x axis: its normal, (0, 0, 1), becomes (0, -sin, cos).
void tilt(Particles<double>& particles, double angle) {
  each_node(particles.grid(), [&](int r, int c) {
    const double y = particles.position_at(r, c).y();
    set(particles.position, r, c,
        {particles.position_at(r, c).x(), y * std::cos(angle), y * std::sin(angle)});
  });
}

TEST(PaperWind, AlongTheClothsNormalPointsDownwind) {
  // The other reading of "unit normal vector": a sheet tilted by 60 degrees is pushed along its own normal
  // with the same lambda, to the side the wind goes, whichever way the wind comes.
  for (double direction : {1.0, -1.0}) {
    Sheet sheet(Discretization::paper);
    tilt(sheet.particles, std::numbers::pi / 3);
    sheet.wind = {{0, 0, direction}, 1.0};
    const VectorField<double> force = sheet.forces(PaperWind<double>({2.0, true}));
    const Vec3 expected = direction * 2.0 * Vec3(0, -std::sqrt(0.75), 0.5);
    each_node(force.grid(), [&](int r, int c) { EXPECT_LT((get(force, r, c) - expected).norm(), 1e-13); });
  }
}

TEST(PaperWind, AlongTheNormalIsPerAreaForTheContinuum) {
  Sheet sheet(Discretization::continuum);
  tilt(sheet.particles, std::numbers::pi / 3);
  sheet.wind = {{0, 0, -1}, 3.0};
  // lambda * speed * area = 0.5 * 3 * 2 = 3 N along (0, sin60, -cos60).
  EXPECT_LT(
      (total(sheet.forces(PaperWind<double>({0.5, true}))) - 3.0 * Vec3(0, std::sqrt(0.75), -0.5)).norm(),
      1e-12);
}

TEST(PaperWind, ACrumpledPointHasNoNormalAndStaysFinite) {
  Sheet sheet(Discretization::paper);
  sheet.particles.position.fill(0);
  sheet.wind = {{0, 0, -1}, 1.0};
  const VectorField<double> force = sheet.forces(PaperWind<double>({1.0, true}));
  each_node(force.grid(), [&](int r, int c) { EXPECT_TRUE(get(force, r, c).allFinite()); });
}

// --- Moving air ---

TEST(Aerodynamics, PushesAFaceByTheDynamicPressure) {
  // Face on to 3 m/s: F = 1/2 rho C w^2 A = 0.5 * 1.225 * 1.2 * 9 * 2 m2 = 13.23 N.
  Sheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  const Vec3 force = total(sheet.forces(Aerodynamics<double>({1.225, 1.2})));
  EXPECT_LT((force - Vec3(0, 0, -13.23)).norm(), 1e-12);
}

TEST(Aerodynamics, FeelsOnlyTheNormalPartOfTheWind) {
  // Tilted by 60 degrees: w.n = 3 cos60 = 1.5 m/s, so a quarter of the pressure, along the normal (0, -sin60,
  // cos60).
  Sheet sheet(Discretization::continuum);
  tilt(sheet.particles, std::numbers::pi / 3);
  sheet.wind = {{0, 0, 1}, 3.0};
  const Vec3 force = total(sheet.forces(Aerodynamics<double>({1.225, 1.2})));
  EXPECT_LT((force - 13.23 / 4 * Vec3(0, -std::sqrt(0.75), 0.5)).norm(), 1e-12);
  sheet.wind = {{1, 0, 0}, 3.0};  // along the sheet: no force from a flat plate
  EXPECT_LT(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).norm(), 1e-12);
}

TEST(Aerodynamics, DependsOnTheRelativeVelocity) {
  // Moving with the air: no force; moving at it: twice the speed, four times the force.
  Sheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, {0, 0, -3}); });
  EXPECT_LT(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).norm(), 1e-12);
  each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, {0, 0, 3}); });
  EXPECT_NEAR(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).z(), -4 * 13.23, 1e-11);
}

TEST(Aerodynamics, RateBoundsTheForcesSlope) {
  // d/dv of 1/2 rho C (w - v)^2 A is rho C w A; over the mass 0.1 A: 1.225 * 1.2 * 3 / 0.1 = 44.1 /s for a
  // flat sheet.
  Sheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  const double rate = Aerodynamics<double>({1.225, 1.2}).max_damping_rate(sheet.particles, sheet.context());
  EXPECT_GE(rate, 44.1 * (1 - 1e-12));
  EXPECT_LE(rate, 2 * 44.1);
}

TEST(Aerodynamics, GrowsOnlyLinearlyBeyondWhatTheSubstepBears) {
  // Held to a rate of 10 /s where the flow asks for 44.1: |w.A| counts as 10 m / (rho C), so that the force
  // is 1/2 rho C |w.A| w = 10 m w / 2 = 0.5 * 10 * 0.1 * 2 * 3 = 3 N. A limit above the rate changes nothing.
  Sheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  EffectContext context = sheet.context();
  context.damping_limit = 10;
  VectorField<double> force(sheet.particles.grid());
  Aerodynamics<double>({1.225, 1.2}).add_forces(sheet.particles, context, force);
  EXPECT_LT((total(force) - Vec3(0, 0, -3)).norm(), 1e-12);
  context.damping_limit = 45;
  force.fill(0);
  Aerodynamics<double>({1.225, 1.2}).add_forces(sheet.particles, context, force);
  EXPECT_LT((total(force) - Vec3(0, 0, -13.23)).norm(), 1e-12);
}

TEST(Aerodynamics, DragGoesWithTheWindAndLiftAcrossIt) {
  // Tilted by 60 degrees: (n.e) = 1/2, w_n = 1.5 m/s. Drag alone: 13.23 N / 4 (n.e) along e = (0, 0, 1). Lift
  // alone: 13.23 N / 4 (n - (n.e) e) with n = (0, -sin60, cos60).
  Sheet sheet(Discretization::continuum);
  tilt(sheet.particles, std::numbers::pi / 3);
  sheet.wind = {{0, 0, 1}, 3.0};
  const Vec3 drag = total(sheet.forces(Aerodynamics<double>({1.225, 1.2, 0.0})));
  EXPECT_LT((drag - Vec3(0, 0, 13.23 / 8)).norm(), 1e-12);
  const Vec3 lift = total(sheet.forces(Aerodynamics<double>({1.225, 0.0, 1.2})));
  EXPECT_LT((lift - Vec3(0, -13.23 / 4 * std::sqrt(0.75), 0)).norm(), 1e-12);
  const Vec3 half = total(sheet.forces(Aerodynamics<double>({1.225, 1.2, 0.6})));
  EXPECT_LT((half - (drag + 0.5 * lift)).norm(), 1e-12);
}

TEST(Aerodynamics, LiftIsAsDragByDefault) {
  Sheet sheet(Discretization::continuum);
  test::randomise(sheet.particles.position, -1, 1, 1);
  test::randomise(sheet.particles.velocity, -1, 1, 2);
  sheet.wind = {{0, 0.6, 0.8}, 3.0};
  const VectorField<double> plain = sheet.forces(Aerodynamics<double>({1.225, 1.2}));
  const VectorField<double> same = sheet.forces(Aerodynamics<double>({1.225, 1.2, 1.2}));
  each_node(plain.grid(), [&](int r, int c) { EXPECT_EQ(get(plain, r, c), get(same, r, c)); });
}

/// Of one face, all of whose corners move alike: -dF/dv by differences, what add_damping gives in all, and
/// the bound of max_damping_rate times the node's mass.
struct Slope {
  Eigen::Matrix3d exact, given;
  double bound;
};
Slope slope_of(const AerodynamicsEffect& parameters, const Vec3& direction, double angle) {
  Sheet sheet(Discretization::continuum);
  sheet.particles = test::flat_sheet<double>(2, 2, {0.5, 0.25});
  tilt(sheet.particles, angle);
  sheet.wind = {direction.normalized(), 3.0};
  const Aerodynamics<double> effect(parameters);
  const auto force_at = [&](const Vec3& velocity) {
    each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, velocity); });
    return total(sheet.forces(effect));
  };
  Slope slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = 1e-4 * Vec3::Unit(axis);
    slope.exact.col(axis) = (force_at(-step) - force_at(step)) / 2e-4;
  }
  force_at(Vec3::Zero());
  const Grid& grid = sheet.particles.grid();
  std::vector<Field<double>> sums(6, Field<double>(grid));
  effect.add_damping(
      sheet.particles, sheet.context(),
      {nullptr,
       {sums[0].row(0), sums[1].row(0), sums[2].row(0), sums[3].row(0), sums[4].row(0), sums[5].row(0)}});
  slope.given.setZero();
  each_node(grid, [&](int r, int c) {
    Eigen::Matrix3d node;
    node << sums[0].at(r, c), sums[1].at(r, c), sums[2].at(r, c), sums[1].at(r, c), sums[3].at(r, c),
        sums[4].at(r, c), sums[2].at(r, c), sums[4].at(r, c), sums[5].at(r, c);
    slope.given += node;
  });
  // The bound is made for a node with four faces; here one has one.
  slope.bound = effect.max_damping_rate(sheet.particles, sheet.context()) * sheet.particles.mass.at(1, 1);
  return slope;
}

double smallest_eigenvalue(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d symmetric = (matrix + matrix.transpose()) / 2;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric).eigenvalues()[0];
}

TEST(Aerodynamics, DampingIsPositiveAndNoLessThanTheForcesSlopeWhateverDragAndLift) {
  for (const auto& [drag, lift] : {std::pair{1.2, 1.2}, {1.2, 0.0}, {0.0, 1.2}, {1.0, 0.3}, {0.3, 2.0}}) {
    for (const double angle : {0.0, 0.3, 0.7, 1.1, 1.5}) {
      for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0.3, 0.8, 0.5), Vec3(1, -0.2, 0.1)}) {
        SCOPED_TRACE(testing::Message() << drag << " " << lift << " " << angle << " " << direction.x());
        const Slope slope = slope_of({1.225, drag, lift}, direction, angle);
        EXPECT_GE(smallest_eigenvalue(slope.given), -1e-12);
        EXPECT_GE(smallest_eigenvalue(slope.given - slope.exact), -1e-6);
        EXPECT_GE(smallest_eigenvalue(slope.bound * Eigen::Matrix3d::Identity() - slope.exact), -1e-6);
      }
    }
  }
}

// --- Air that differs from node to node ---

TEST(NodeAirForces, AreThoseOfAUniformWindWhereTheAirIsTheSameEverywhere) {
  Sheet sheet(Discretization::continuum);
  test::randomise(sheet.particles.position, -1, 1, 1);
  test::randomise(sheet.particles.velocity, -1, 1, 2);
  sheet.wind = {{0, 0.6, 0.8}, 2.5};  // (0, 1.5, 2): exact in single precision
  VectorField<float> air(sheet.particles.grid());
  each_node(air.grid(), [&](int r, int c) { set(air, r, c, {0, 1.5, 2}); });
  EffectContext context = sheet.context();
  context.node_air = &air;
  const Aerodynamics<double> plate({1.225, 1.2}), wing({1.225, 1.2, 0.4});
  const PaperWind<double> straight({0.5, false}), turned({0.5, true});
  for (const Effect<double>* effect :
       std::initializer_list<const Effect<double>*>{&plate, &wing, &straight, &turned}) {
    const VectorField<double> uniform = sheet.forces(*effect);
    VectorField<double> force(sheet.particles.grid());
    effect->add_forces(sheet.particles, context, force);
    each_node(force.grid(), [&](int r, int c) {
      EXPECT_LT((get(force, r, c) - get(uniform, r, c)).norm(), 1e-12) << effect->name();
    });
    EXPECT_NEAR(effect->max_damping_rate(sheet.particles, context),
                effect->max_damping_rate(sheet.particles, sheet.context()), 1e-9);
  }
}

TEST(NodeAirForces, EachNodeAndFaceFeelsItsOwnAir) {
  // Still on the left half, 2 m/s on the right: the paper's wind of 0.5 N at 1 m/s is 1 N there. The pressure
  // on a face goes by the mean of its corners' air: 0, 1/2 rho C (1 m/s)^2 on the faces between, and four
  // times that, each of 1/16 m2.
  Sheet sheet(Discretization::paper);
  VectorField<float> air(sheet.particles.grid());
  each_node(air.grid(), [&](int r, int c) { set(air, r, c, {0, 0, c > 4 ? -2.0 : 0.0}); });
  EffectContext context = sheet.context();
  context.node_air = &air;
  VectorField<double> force(sheet.particles.grid());
  PaperWind<double>({0.5, false}).add_forces(sheet.particles, context, force);
  each_node(force.grid(), [&](int r, int c) { EXPECT_EQ(get(force, r, c), Vec3(0, 0, c > 4 ? -1.0 : 0.0)); });
  force.fill(0);
  Aerodynamics<double>({1.225, 1.2}).add_forces(sheet.particles, context, force);
  const double face = 0.5 * 1.225 * 1.2 / 16;
  EXPECT_NEAR(get(force, 2, 3).z(), 0, 1e-15);
  EXPECT_NEAR(get(force, 2, 4).z(), -2 * face / 4, 1e-15);
  EXPECT_NEAR(get(force, 2, 6).z(), -4 * 4 * face / 4, 1e-15);
  EXPECT_NEAR(total(force).z(), -4 * face - 3 * 4 * 4 * face, 1e-14);
}

TEST(Aerodynamics, ACrumpledPointHasNoFaceAndStaysFinite) {
  Sheet sheet(Discretization::continuum);
  sheet.particles.position.fill(0);
  sheet.wind = {{0, 0, -1}, 10.0};
  const VectorField<double> force = sheet.forces(Aerodynamics<double>({}));
  each_node(force.grid(), [&](int r, int c) { EXPECT_EQ(get(force, r, c), Vec3(0, 0, 0)); });
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
  const Sheet sheet(Discretization::paper);
  for (const auto& effect : make_effects<double>({GravityEffect{}, PaperWindEffect{}})) {
    EXPECT_EQ(effect->max_damping_rate(sheet.particles, sheet.context()), 0.0) << effect->name();
  }
}

TEST(Equation5, TheResultantIsTheSumOfElasticGravityResistanceAndWind) {
  Sheet sheet(Discretization::paper);
  sheet.cloth.material.damping = 2;
  sheet.wind = {{0, 0, -1}, 1.5};
  test::randomise(sheet.particles.position, -1, 1, 1);
  test::randomise(sheet.particles.velocity, -1, 1, 2);
  const Springs<double> springs(sheet.cloth.material, Discretization::paper, {2, 1}, sheet.particles.grid());
  const auto effects = make_effects<double>({GravityEffect{}, DampingEffect{}, PaperWindEffect{}});
  VectorField<double> elastic(sheet.particles.grid()), sum(sheet.particles.grid());
  springs.add_forces(sheet.particles.position, elastic);
  sum.fill(123.0);  // whatever was there is overwritten
  Forces<double>{&springs, &effects, sheet.context()}.sum(sheet.particles, sum);
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
