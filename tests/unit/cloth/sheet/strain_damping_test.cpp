// strain_damping: springs that resist the rate of their length, and nothing else.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "cloth/integrators/symplectic_euler.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/cloth.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::kFrame;
using test::ListedSpring;
using test::Rig;
using test::set;

constexpr double kTime = 0.02;  // tau, s

Springs<double> damped_springs(Discretization discretization, const Grid& grid) {
  return Springs<double>(Material{}, discretization, {2, 1}, grid, kTime);
}

/// The damping of nodes that move at `velocity`.
VectorField<double> damping_of(const Springs<double>& springs, const VectorField<double>& position,
                               const VectorField<double>& velocity) {
  VectorField<double> force(position.grid());
  springs.add_damping(position, kernels::components(velocity), force);
  return force;
}

TEST(StrainDamping, IsMinusTauKTimesTheRateOfEachSpringsLength) {
  // Against a list of springs, each by the formula itself; sums of up to 24 terms of size 2e3 N.
  for (const Discretization d : {Discretization::paper, Discretization::continuum}) {
    for (const auto& [rows, cols] : std::vector<std::pair<int, int>>{{2, 2}, {3, 2}, {5, 7}, {9, 34}}) {
      const Grid grid = Grid::with_nodes(rows, cols);
      const Springs<double> springs = damped_springs(d, grid);
      VectorField<double> position(grid), velocity(grid), expected(grid);
      test::randomise(position, -1, 1, 1);
      test::randomise(velocity, -3, 3, 2);
      for (const ListedSpring& s : test::list_springs(springs.families(), grid)) {
        const Vec3 n = (get(position, s.r0, s.c0) - get(position, s.r1, s.c1)).normalized();
        const Vec3 relative = get(velocity, s.r0, s.c0) - get(velocity, s.r1, s.c1);
        const Vec3 force = -kTime * s.stiffness * n.dot(relative) * n;
        set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + force);
        set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - force);
      }
      EXPECT_LT(test::largest_difference(damping_of(springs, position, velocity), expected), 1e-9);
    }
  }
}

TEST(StrainDamping, KeepsMomentumAndAngularMomentum) {
  const Grid grid = Grid::with_nodes(9, 12);
  VectorField<double> position(grid), velocity(grid);
  test::randomise(position, -1, 1, 3);
  test::randomise(velocity, -3, 3, 4);
  const VectorField<double> force =
      damping_of(damped_springs(Discretization::continuum, grid), position, velocity);
  test::expect_no_net_force(position, force);
}

TEST(StrainDamping, LeavesRigidMotionAlone) {
  // v = v0 + w x r changes no length, whatever the shape; forces of stretching at this speed would be of
  // size tau Y v = 0.02 * 5000 * 3.
  const Grid grid = Grid::with_nodes(9, 12);
  VectorField<double> position(grid), velocity(grid);
  test::randomise(position, -1, 1, 5);
  each_node(grid, [&](int r, int c) {
    set(velocity, r, c, Vec3(1, 2, -3) + Vec3(-2, 0.5, 1).cross(get(position, r, c)));
  });
  const VectorField<double> force =
      damping_of(damped_springs(Discretization::continuum, grid), position, velocity);
  each_node(grid, [&](int r, int c) { EXPECT_LT(get(force, r, c).norm(), 1e-10); });
}

TEST(StrainDamping, OverAWayIsMinusTauKTimesTheGrowthOfEachSpringPerTime) {
  // As above; turned and stretched at random by as much as the sheet is large.
  constexpr double kStep = 0.05;  // s
  const Grid grid = Grid::with_nodes(5, 7);
  const Springs<double> springs = damped_springs(Discretization::continuum, grid);
  VectorField<double> position(grid), way(grid), expected(grid), force(grid);
  test::randomise(position, -1, 1, 8);
  test::randomise(way, -1, 1, 9);
  for (const ListedSpring& s : test::list_springs(springs.families(), grid)) {
    const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1);
    const Vec3 began = d - get(way, s.r0, s.c0) + get(way, s.r1, s.c1);
    const Vec3 on_first = -kTime / kStep * s.stiffness * (d.norm() - began.norm()) * d.normalized();
    set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + on_first);
    set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - on_first);
  }
  springs.add_damping(position, kernels::components(way), kStep, force);
  EXPECT_LT(test::largest_difference(force, expected), 1e-9);
}

TEST(StrainDamping, OverAWayLeavesATurnAlone) {
  // By a radian about a skew axis; along where it ends a spring of length l would seem to have grown by
  // l (1 - cos 1), at stiffnesses of 5000 N/m forces of 1e3 N and more.
  const Grid grid = Grid::with_nodes(9, 12);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1, Vec3(1, 2, -2) / 3).toRotationMatrix();
  VectorField<double> position(grid), way(grid), force(grid);
  test::randomise(position, -1, 1, 10);
  each_node(grid, [&](int r, int c) {
    const Vec3 began = get(position, r, c), ended = turn * began + Vec3(3, 1, -2);
    set(way, r, c, ended - began);
    set(position, r, c, ended);
  });
  damped_springs(Discretization::continuum, grid)
      .add_damping(position, kernels::components(way), 0.05, force);
  each_node(grid, [&](int r, int c) { EXPECT_LT(get(force, r, c).norm(), 1e-9); });
}

TEST(StrainDamping, UndampedSpringsAddNothing) {
  const Grid grid = Grid::with_nodes(5, 5);
  const Springs<double> springs(Material{}, Discretization::continuum, {1, 1}, grid);
  VectorField<double> position(grid), velocity(grid), force(grid);
  test::randomise(position, -1, 1, 6);
  test::randomise(velocity, -1, 1, 7);
  springs.add_damping(position, kernels::components(velocity), force);
  EXPECT_TRUE(test::same_bits(force, VectorField<double>(grid)));
}

// --- One spring ---

/// Two nodes 1 m apart along x, twice; the left ones held, the right ones of 1 kg on a spring of k N/m.
Rig<double> damped_oscillator(double k, const IntegratorDescription& stepping) {
  Particles<double> sheet = test::flat_sheet<double>(2, 2, {1, 1});
  for (int r : {0, 1}) sheet.inverse_mass.at(r, 0) = 0;
  Material material = test::without_springs();
  material.structural = k;
  return {std::move(sheet), {1, 1}, material, Discretization::paper, {StrainDampingEffect{kTime}}, stepping};
}

/// Steps of h from 0.1 m beside its home at rest, by next(x, v) -> v at the step's end.
template <class Next>
void expect_steps(Rig<double> rig, double h, Next next) {
  const double home = rig.particles.position.x.at(0, 1);
  for (int r : {0, 1}) rig.particles.position.x.at(r, 1) += 0.1;
  double x = 0.1, v = 0;
  for (int n = 1; n <= 100; ++n) {
    rig.advance((n - 1) * h, h);
    v = next(x, v);
    x += h * v;
    ASSERT_NEAR(rig.particles.position.x.at(0, 1) - home, x, 1e-12) << n;
  }
}

// Each method's own formula for x'' = -w^2 (x + tau x'), m = 1 kg.
TEST(DampedOscillator, IsSymplecticEulers) {
  constexpr double h = 0.01, k = 40;
  expect_steps(damped_oscillator(k, SymplecticEulerDescription{1}), h,
               [](double x, double v) { return v - h * k * (x + kTime * v); });
}

TEST(DampedOscillator, IsBackwardEulers) {
  constexpr double h = 0.01, k = 40;
  BackwardEulerDescription exact;
  exact.tolerance = 1e-12;
  exact.newton_iterations = 3;
  // v' = v - h k (x + h v' + tau v')
  const auto next = [](double x, double v) { return (v - h * k * x) / (1 + h * k * (h + kTime)); };
  expect_steps(damped_oscillator(k, exact), h, next);
  expect_steps(damped_oscillator(k, XpbdDescription{1}), h, next);  // one spring projected once
}

TEST(DampedOscillator, IsBoundedForAnyTime) {
  // tau = 10 s on w = 6 kHz: an explicit step would need a rate of tau w^2 = 4e8 / s. Overdamped, it creeps
  // home at 1 / tau: in a second by a tenth of its way.
  for (const IntegratorDescription& stepping :
       {IntegratorDescription{BackwardEulerDescription{}}, IntegratorDescription{Bdf2Description{}},
        IntegratorDescription{XpbdDescription{10}}}) {
    Rig<double> rig = damped_oscillator(4e7, stepping);
    rig.sheet = Sheet<double>(
        Springs<double>(rig.cloth.material, Discretization::paper, {1, 1}, rig.particles.grid(), 10));
    for (int r : {0, 1}) rig.particles.position.x.at(r, 1) += 0.1;
    for (int n = 0; n < 60; ++n) rig.advance(n * kFrame, kFrame);
    EXPECT_NEAR(rig.particles.position.x.at(0, 1) - 0.5, 0.1 * std::exp(-0.1), 1e-3);
  }
}

// --- Sheets ---

TEST(StrainDamping, SymplecticEulersOwnSubstepsAreStable) {
  // The stiffest mode decays; with the substeps of the undamped sheet it would grow without bound.
  Rig<double> rig = test::sheet_rig<double>(9, 9, SymplecticEulerDescription{}, {StrainDampingEffect{0.01}});
  test::randomise(rig.particles.velocity, -0.01, 0.01, 8);
  const double before = kinetic_energy(rig.particles);
  const AdvanceReport report = rig.advance(0, kFrame);
  const double w2 = rig.springs().max_squared_frequency(rig.particles.mass);
  EXPECT_EQ(report.substeps, stable_substeps(w2, 0.01 * w2, kFrame, 0.9));
  EXPECT_GT(report.substeps, 4 * stable_substeps(w2, 0, kFrame, 0.9));
  for (int n = 1; n < 60; ++n) rig.advance(n * kFrame, kFrame);
  EXPECT_LT(kinetic_energy(rig.particles), before);
}

// Damping bears no load at rest, so that XPBD leaves a hung sheet as long as without it. With multipliers
// that begin from zero the stretch would be 14 times as large.
TEST(StrainDamping, LeavesXpbdsStretchAtRest) {
  const auto hung_length = [](const std::vector<EffectDescription>& effects) {
    std::vector<EffectDescription> all{GravityEffect{}};
    all.insert(all.end(), effects.begin(), effects.end());
    Rig<double> rig = test::sheet_rig<double>(17, 17, XpbdDescription{40}, all);
    for (int c = 0; c < 17; ++c) rig.particles.inverse_mass.at(0, c) = 0;
    const double top = get(rig.particles.position, 0, 8).y();
    // e^-100 of the creep at 1 / tau is left; of the slowest stretching, w = pi / 4 sqrt(Y / rho), which XPBD
    // damps at w^2 h / 2 = 6 / s, e^-13.
    for (int n = 0; n < 120; ++n) rig.advance(n * kFrame, kFrame);
    return top - get(rig.particles.position, 16, 8).y();
  };
  const double undamped = hung_length({}) - 2, damped = hung_length({StrainDampingEffect{kTime}}) - 2;
  EXPECT_GT(undamped, 3.9e-4);  // rho g L^2 / (2 Y), and XPBD's own
  EXPECT_NEAR(damped / undamped, 1, 0.01);
}

TEST(StrainDamping, MovingPinsDragNothingButWhatTheyStretch) {
  // The whole sheet flies along with its pinned edge: no length changes, so nothing may fall behind. Without
  // the pins' own velocity it would lag by tau v = 20 mm.
  BackwardEulerDescription backward_euler;
  Bdf2Description bdf2;
  backward_euler.tolerance = bdf2.tolerance = 1e-6;
  for (const IntegratorDescription& stepping :
       {IntegratorDescription{SymplecticEulerDescription{}}, IntegratorDescription{backward_euler},
        IntegratorDescription{bdf2}, IntegratorDescription{XpbdDescription{20}}}) {
    ClothDescription cloth;
    cloth.min_level = cloth.max_level = cloth.initial_level = 3;
    cloth.velocity = {1, 0, 0};
    cloth.pins = {{0, 0, 0, 1, {{0, {0, 0, 0}}, {10, {10, 0, 0}}}}};
    Cloth<double> sheet(cloth, {StrainDampingEffect{kTime}}, stepping, 1);
    for (int n = 0; n < 30; ++n) sheet.advance({}, {}, n * kFrame, kFrame);
    const Particles<double>& state = sheet.particles();
    each_node(state.grid(), [&](int r, int c) {
      const double at_rest = -1 + 0.25 * c;
      // An explicit substep of 13 us sees the pins where they will be at its end: 13 um ahead.
      EXPECT_NEAR(state.position.x.at(r, c), at_rest + 0.5, 2e-5) << c;
    });
  }
}

}  // namespace
}  // namespace weft
