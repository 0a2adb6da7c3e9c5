// Moving air on faces: pressure, drag and lift, and air that differs from node to node.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "cloth/forces/aerodynamics.h"
#include "cloth/forces/paper_wind.h"
#include "effect_sheet.h"

namespace weft {
namespace {

using test::each_node;
using test::EffectSheet;
using test::get;
using test::set;
using test::tilt;
using test::total;

TEST(Aerodynamics, PushesAFaceByTheDynamicPressure) {
  // Face on to 3 m/s: F = 1/2 rho C w^2 A = 0.5 * 1.225 * 1.2 * 9 * 2 m2 = 13.23 N.
  EffectSheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  const Vec3 force = total(sheet.forces(Aerodynamics<double>({1.225, 1.2})));
  EXPECT_LT((force - Vec3(0, 0, -13.23)).norm(), 1e-12);
}

TEST(Aerodynamics, FeelsOnlyTheNormalPartOfTheWind) {
  // Tilted by 60 degrees: w.n = 3 cos60 = 1.5 m/s, so a quarter of the pressure, along the normal (0, -sin60,
  // cos60).
  EffectSheet sheet(Discretization::continuum);
  tilt(sheet.particles, std::numbers::pi / 3);
  sheet.wind = {{0, 0, 1}, 3.0};
  const Vec3 force = total(sheet.forces(Aerodynamics<double>({1.225, 1.2})));
  EXPECT_LT((force - 13.23 / 4 * Vec3(0, -std::sqrt(0.75), 0.5)).norm(), 1e-12);
  sheet.wind = {{1, 0, 0}, 3.0};  // along the sheet: no force from a flat plate
  EXPECT_LT(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).norm(), 1e-12);
}

TEST(Aerodynamics, DependsOnTheRelativeVelocity) {
  // Moving with the air: no force; moving at it: twice the speed, four times the force.
  EffectSheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, {0, 0, -3}); });
  EXPECT_LT(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).norm(), 1e-12);
  each_node(sheet.particles.grid(), [&](int r, int c) { set(sheet.particles.velocity, r, c, {0, 0, 3}); });
  EXPECT_NEAR(total(sheet.forces(Aerodynamics<double>({1.225, 1.2}))).z(), -4 * 13.23, 1e-11);
}

TEST(Aerodynamics, RateBoundsTheForcesSlope) {
  // d/dv of 1/2 rho C (w - v)^2 A is rho C w A; over the mass 0.1 A: 1.225 * 1.2 * 3 / 0.1 = 44.1 /s for a
  // flat sheet.
  EffectSheet sheet(Discretization::continuum);
  sheet.wind = {{0, 0, -1}, 3.0};
  const double rate = Aerodynamics<double>({1.225, 1.2}).max_damping_rate(sheet.particles, sheet.context());
  EXPECT_GE(rate, 44.1 * (1 - 1e-12));
  EXPECT_LE(rate, 2 * 44.1);
}

TEST(Aerodynamics, GrowsOnlyLinearlyBeyondWhatTheSubstepBears) {
  // Held to a rate of 10 /s where the flow asks for 44.1: |w.A| counts as 10 m / (rho C), so that the force
  // is 1/2 rho C |w.A| w = 10 m w / 2 = 0.5 * 10 * 0.1 * 2 * 3 = 3 N. A limit above the rate changes nothing.
  EffectSheet sheet(Discretization::continuum);
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
  EffectSheet sheet(Discretization::continuum);
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
  EffectSheet sheet(Discretization::continuum);
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
  EffectSheet sheet(Discretization::continuum);
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
  EffectSheet sheet(Discretization::continuum);
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
  EffectSheet sheet(Discretization::paper);
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
  EffectSheet sheet(Discretization::continuum);
  sheet.particles.position.fill(0);
  sheet.wind = {{0, 0, -1}, 10.0};
  const VectorField<double> force = sheet.forces(Aerodynamics<double>({}));
  each_node(force.grid(), [&](int r, int c) { EXPECT_EQ(get(force, r, c), Vec3(0, 0, 0)); });
}

}  // namespace
}  // namespace weft
