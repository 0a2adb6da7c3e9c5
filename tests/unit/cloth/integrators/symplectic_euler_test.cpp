// Eq. 6, its order and its limit of stability; free fall (T1), damped fall (T2), one oscillator (T5), a chain
// in time (T7), momentum (T15).
#include "cloth/integrators/symplectic_euler.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <utility>

#include "cloth/sheet/diagnostics.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::kFrame;
using test::Rig;
using test::without_springs;

/// Node (r, 1) of 2 x 3 nodes 1 m apart is free to swing along x between two held ones, on springs of k each:
/// m = 1 kg, w^2 = 2k. Both rows move alike, so the cross springs stay at rest.
Rig<double> oscillator(double k, int substeps) {
  Particles<double> sheet = test::flat_sheet<double>(2, 3, {2, 1});
  for (int r : {0, 1}) {
    for (int c : {0, 2}) sheet.inverse_mass.at(r, c) = 0;
  }
  Material material = without_springs();
  material.structural = k;
  return {std::move(sheet),      {2, 1}, material,
          Discretization::paper, {},     SymplecticEulerDescription{substeps, 0.9}};
}

// --- Eq. 6, one substep by hand ---

TEST(Equation6, VelocityFirstThenPositionWithTheNewVelocity) {
  // k = 50 N/m, w^2 = 100; x = 0.1 m, v = 2 m/s, dt = 0.01 s:
  // a = -100 * 0.1 = -10; v = 2 - 10 * 0.01 = 1.9; x = 0.1 + 1.9 * 0.01 = 0.119 (with the old v it would be
  // 0.12).
  Rig<double> rig = oscillator(50, 1);
  for (int r : {0, 1}) {
    rig.particles.position.x.at(r, 1) = 0.1;
    rig.particles.velocity.x.at(r, 1) = 2;
  }
  EXPECT_EQ(rig.advance(0, 0.01).substeps, 1);
  EXPECT_NEAR(rig.particles.acceleration.x.at(0, 1), -10, 1e-12);
  EXPECT_NEAR(rig.particles.velocity.x.at(0, 1), 1.9, 1e-14);
  EXPECT_NEAR(rig.particles.position.x.at(0, 1), 0.119, 1e-15);
}

TEST(Equation6, SubstepsDivideTheStep) {
  // The same, as two substeps of 0.005: v1 = 2 - 0.05 = 1.95, x1 = 0.10975; a = -10.975,
  // v2 = 1.95 - 0.054875 = 1.895125, x2 = 0.10975 + 0.009475625 = 0.119225625.
  Rig<double> rig = oscillator(50, 2);
  for (int r : {0, 1}) {
    rig.particles.position.x.at(r, 1) = 0.1;
    rig.particles.velocity.x.at(r, 1) = 2;
  }
  EXPECT_EQ(rig.advance(0, 0.01).substeps, 2);
  EXPECT_NEAR(rig.particles.acceleration.x.at(0, 1), -10.975, 1e-11);
  EXPECT_NEAR(rig.particles.velocity.x.at(0, 1), 1.895125, 1e-13);
  EXPECT_NEAR(rig.particles.position.x.at(0, 1), 0.119225625, 1e-14);
}

TEST(Equation6, HeldNodesStayWhateverPulls) {
  Rig<double> rig = oscillator(50, 1);
  rig.effects = make_effects<double>({GravityEffect{}});
  const Particles<double> start = rig.particles;
  for (int step = 0; step < 10; ++step) rig.advance(step * 0.01, 0.01);
  for (int r : {0, 1}) {
    for (int c : {0, 2}) {
      EXPECT_EQ(rig.particles.position_at(r, c), start.position_at(r, c));
      EXPECT_EQ(rig.particles.velocity_at(r, c), Vec3(0, 0, 0));
    }
    EXPECT_LT(rig.particles.position_at(r, 1).y(), start.position_at(r, 1).y());
  }
}

// --- T1, T2 ---

template <class Real>
class FreeFall : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(FreeFall, Scalars);

TYPED_TEST(FreeFall, OneSecondFallsByTheSumOfTheSteps) {
  // T1: v after step i is -g dt i, so y = -g dt^2 (1 + ... + n) = -9.81 / 3600 * 60 * 61 / 2 = -4.98675 m.
  // Springs at rest; a float sheet rounds 60 times at up to 5 m (3e-7), and its springs answer the rounding.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {2, 2});
  test::share_mass(sheet, 0.4, Discretization::continuum);
  const Particles<TypeParam> start = sheet;
  Rig<TypeParam> rig(std::move(sheet), {2, 2}, without_springs(), Discretization::continuum,
                     {GravityEffect{}}, SymplecticEulerDescription{1, 0.9});
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  const double tolerance = std::is_same_v<TypeParam, float> ? 2e-5 : 1e-12;
  each_node(start.grid(), [&](int r, int c) {
    const Vec3 fall = rig.particles.position_at(r, c) - start.position_at(r, c);
    EXPECT_NEAR(fall.y(), -4.98675, tolerance);
    EXPECT_EQ(fall.x(), 0.0);
    EXPECT_EQ(fall.z(), 0.0);
  });
}

TEST(DampedFall, FollowsTheStepsOwnLawAndThePapersLimit) {
  // T2. Each step multiplies the distance to the limit m g / k by (1 - k dt / m): v_n = (m g / k)(1 - (1 - k
  // dt/m)^n). m = 0.4 / 81 kg, k = 0.01 N s/m: k/m = 2.025 /s, limit 4.844444 m/s.
  Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
  test::share_mass(sheet, 0.4, Discretization::paper);
  Material material = without_springs();
  material.damping = 0.01;
  Rig<double> rig(std::move(sheet), {2, 2}, material, Discretization::paper,
                  {GravityEffect{}, DampingEffect{}}, SymplecticEulerDescription{1, 0.9});
  const double rate = 0.01 * 81 / 0.4, limit = 9.81 / rate;
  for (int step = 0; step < 600; ++step) {
    rig.advance(step * kFrame, kFrame);
    const double expected = -limit * (1 - std::pow(1 - rate * kFrame, step + 1));
    ASSERT_NEAR(rig.particles.velocity_at(4, 4).y(), expected, 1e-12) << step;
  }
  EXPECT_NEAR(rig.particles.velocity_at(4, 4).y(), -4.844444, 1e-6);
}

TEST(DampedFall, ApproachesTheExponentialAsTheSubstepShrinks) {
  // T2: v(t) = -(m g / k)(1 - exp(-k t / m)); first order, so the error at 1 s halves with the substep.
  const double rate = 0.01 * 81 / 0.4, exact = -9.81 / rate * (1 - std::exp(-rate));
  const auto error = [&](int substeps) {
    Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
    test::share_mass(sheet, 0.4, Discretization::paper);
    Material material = without_springs();
    material.damping = 0.01;
    Rig<double> rig(std::move(sheet), {2, 2}, material, Discretization::paper,
                    {GravityEffect{}, DampingEffect{}}, SymplecticEulerDescription{substeps, 0.9});
    for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
    return std::abs(rig.particles.velocity_at(4, 4).y() - exact);
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(coarse / fine, 2.0, 0.02);
}

// --- T5: the limit of stability ---

TEST(StabilityLimit, BelowItTheSchemesOwnEnergyIsKept) {
  // Symplectic Euler conserves v^2 + w^2 x^2 - dt w^2 x v exactly; it is positive for w dt < 2, so the motion
  // is bounded. w dt = 1.99, 1e5 steps: only rounding, which grows at most linearly: 1e5 * 1e-16 with a
  // factor for the ill-conditioned form near the limit.
  const double dt = 0.01, w = 1.99 / dt;
  Rig<double> rig = oscillator(w * w / 2, 1);
  for (int r : {0, 1}) rig.particles.position.x.at(r, 1) = 1e-3;
  const auto invariant = [&] {
    const double x = rig.particles.position.x.at(0, 1), v = rig.particles.velocity.x.at(0, 1);
    return v * v + w * w * x * x - dt * w * w * x * v;
  };
  const double start = invariant();
  for (int step = 0; step < 100'000; ++step) rig.advance(0, dt);
  EXPECT_NEAR(invariant() / start, 1.0, 1e-8);
}

TEST(StabilityLimit, AboveItTheMotionBlowsUp) {
  // w dt = 2.01: the larger root of z^2 - (2 - 2.01^2) z + 1 is -1.22, so 100 steps grow by 1.22^100 = 4e8.
  const double dt = 0.01, w = 2.01 / dt;
  Rig<double> rig = oscillator(w * w / 2, 1);
  for (int r : {0, 1}) rig.particles.position.x.at(r, 1) = 1e-9;  // small enough not to flip the springs over
  for (int step = 0; step < 100; ++step) rig.advance(0, dt);
  EXPECT_GT(std::abs(rig.particles.position.x.at(0, 1)), 1e-3);
}

TEST(StableSubsteps, IsTheSmallestCountWithinTheLimit) {
  // w^2 h^2 + 2 c h <= 4 safety^2, by hand.
  EXPECT_EQ(stable_substeps(16.0, 0.0, 1.0, 1.0), 2);    // 16/4 = 4
  EXPECT_EQ(stable_substeps(16.001, 0.0, 1.0, 1.0), 3);  // just over
  EXPECT_EQ(stable_substeps(16.0, 0.0, 1.0, 0.5), 4);    // 16/16 = 1 = 4 * 0.25
  EXPECT_EQ(stable_substeps(0.0, 10.0, 1.0, 1.0), 5);    // 2 * 10 / 5 = 4
  EXPECT_EQ(stable_substeps(9.0, 3.5, 1.0, 1.0), 3);     // 1 + 7/3 = 3.33; two would be 2.25 + 3.5
  EXPECT_EQ(stable_substeps(0.0, 0.0, 1.0, 0.9), 1);
  // The default cloth at level 6: 8 Y / m per structural spring alone is 4.096e8 /s2, w = 20238.6 /s; at 1/60
  // s and 0.9 of the limit 20238.6 / 60 / 1.8 = 187.4 substeps.
  EXPECT_EQ(stable_substeps(4.096e8, 0.0, kFrame, 0.9), 188);
}

TEST(StableSubsteps, IsBoundedForAbsurdStiffness) {
  EXPECT_EQ(stable_substeps(1e30, 0.0, 1.0, 0.9), kMaxSubsteps);
  EXPECT_EQ(stable_substeps(0.0, 1e30, 1.0, 0.9), kMaxSubsteps);
}

TEST(StableSubsteps, TheCriterionIsThatOfTheSchemesRoots) {
  // z^2 - (2 - c h - w^2 h^2) z + 1 - c h = 0: both roots within the unit circle at the chosen count with
  // safety 1, and, where damping alone does not limit, one outside it at one substep less.
  const auto largest_root = [](double w2, double c, double h) {
    const std::complex<double> b = 2 - c * h - w2 * h * h, q = std::sqrt(b * b - 4.0 * (1 - c * h));
    return std::max(std::abs((b + q) / 2.0), std::abs((b - q) / 2.0));
  };
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(0, 4);
  for (int trial = 0; trial < 1000; ++trial) {
    const double w2 = std::pow(10, 2 * exponent(random)), c = std::pow(10, exponent(random)) - 1;
    const int n = stable_substeps(w2, c, 1.0, 1.0);
    ASSERT_LE(largest_root(w2, c, 1.0 / n), 1 + 1e-7) << w2 << ", " << c;
    if (n > 1) {
      ASSERT_GT(largest_root(w2, c, 1.0 / (n - 1)), 1.0) << w2 << ", " << c;
    }
  }
}

/// A sheet at rest whose nodes lie off their places by up to `most` m in each direction, stepped for a
/// second.
struct CrumpledSheet {
  double energy_before, energy_after;  ///< J, of springs and motion
  int first_substeps, last_substeps;
  int changes = 0;  ///< of the substeps from one step to the next

  explicit CrumpledSheet(double most, int substeps = 0) {
    Rig<double> rig = test::sheet_rig<double>(17, 17, SymplecticEulerDescription{substeps, 0.6}, {},
                                              test::stiffnesses(5000, 500, 0));
    VectorField<double> off(rig.particles.grid());
    test::randomise(off, -most, most, 7);
    test::each_node(off.grid(), [&](int r, int c) {
      test::set(rig.particles.position, r, c, rig.particles.position_at(r, c) + test::get(off, r, c));
    });
    const auto energy = [&] {
      return kinetic_energy(rig.particles) + rig.springs().energy(rig.particles.position);
    };
    energy_before = energy();
    first_substeps = last_substeps = rig.advance(0, kFrame).substeps;
    for (int step = 1; step < 60; ++step) {
      const int before = std::exchange(last_substeps, rig.advance(step * kFrame, kFrame).substeps);
      if (last_substeps != before) ++changes;
    }
    energy_after = energy();
  }
};

TEST(StableSubsteps, AreMoreWhileSpringsTurnOver) {
  // Cells of 0.125 m, whose nodes lie up to as much off, or 0.3 m. Nothing takes energy or brings any in, so
  // there should be as much in the end; the sheets are within 0.0012 of it. By the fewest substeps the second
  // has 20 times as much; by those that each step alone asks for, 34 changes, the first 1.04 times.
  const int fewest = CrumpledSheet(1e-6).first_substeps;
  for (const double most : {0.11, 0.3}) {
    const CrumpledSheet wild(most);
    EXPECT_NEAR(wild.energy_after / wild.energy_before, 1, 0.005) << most;
    EXPECT_GE(wild.first_substeps, 4 * fewest) << most;
    EXPECT_LE(wild.changes, 2) << most;
  }
  const CrumpledSheet heated(0.3, fewest);
  EXPECT_GT(heated.energy_after, 2 * heated.energy_before);
  // Ends that come nearer by at most 2 sqrt(3) 0.03 = 0.104 m do not pass: no more substeps than the stiffest
  // mode needs.
  EXPECT_EQ(CrumpledSheet(0.03).last_substeps, fewest);
}

/// A sheet hung by two corners in a wind, paper's masses; returns its largest kinetic energy over `steps`, J.
double largest_energy(int substeps, int steps, int* used) {
  Particles<float> sheet = test::flat_sheet<float>(17, 17, {2, 2});
  test::share_mass(sheet, 0.4, Discretization::continuum);
  sheet.inverse_mass.at(0, 0) = sheet.inverse_mass.at(0, 16) = 0;
  Rig<float> rig(std::move(sheet), {2, 2}, Material{}, Discretization::continuum,
                 {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}},
                 SymplecticEulerDescription{substeps, 0.9});
  rig.wind = {{0, 0, -1}, 3.0};
  double largest = 0;
  for (int step = 0; step < steps; ++step) {
    *used = rig.advance(step * kFrame, kFrame).substeps;
    const double energy = kinetic_energy(rig.particles);
    if (!std::isfinite(energy)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, energy);
  }
  return largest;
}

TEST(AutomaticSubsteps, KeepAHungClothStableAndFarFewerDoNot) {
  // All the energy there is: 0.4 kg falling 2 m (7.8 J), and what the wind adds (9 Pa/m2 over a few metres).
  int chosen = 0, used = 0;
  EXPECT_LT(largest_energy(0, 2000, &chosen), 40.0);
  EXPECT_GT(chosen, 20);  // w^2 >= 8 * 5000 / (0.4/256): 5060 /s / 60 / 1.8 = 46.8 without shear and bending
  EXPECT_LT(chosen, 100);
  // The limit is at 0.9 of the chosen count for the worst shape; a third of it is beyond it for any.
  EXPECT_GT(largest_energy(chosen / 3, 60, &used), 1e3);
  EXPECT_EQ(used, chosen / 3);
}

// --- Blows of slow effects ---

/// Kinetic energy, J, after four seconds in a steady wind of a drum stretched to twice its size that somebody
/// has hardly touched, everywhere.
double ringing(double stiffness, double wind, int substeps) {
  Material material;
  material.structural = material.shear = stiffness;
  Rig<double> rig = test::sheet_rig<double>(17, 17, SymplecticEulerDescription{substeps, 0.9},
                                            {AerodynamicsEffect{}}, material);
  rig.wind = {{0, 0, 1}, wind};
  test::randomise(rig.particles.velocity, -0.01, 0.01, 4);
  each_node(rig.particles.grid(), [&](int r, int c) {
    rig.particles.position.x.at(r, c) *= 2;
    rig.particles.position.y.at(r, c) *= 2;
    if (r % 16 == 0 || c % 16 == 0) rig.particles.inverse_mass.at(r, c) = 0;
  });
  for (int step = 0; step < 240; ++step) rig.advance(step * kFrame, kFrame);
  return kinetic_energy(rig.particles);
}

// What is left is within the sheet, where air hardly damps it, whatever the wind: 9e-5 and 2e-5 J by 600
// substeps that each have the air's force. A method that gives the wind itself in blows leaves 4 to 20 times
// as much in modes that ring with them; one that finds drag half a substep late, 80 to 3,600 times.
TEST(SlowEffects, LeaveATautDrumAsQuietAsSmallerStepsDoSlow) {
  for (const double stiffness : {20'000.0, 100'000.0}) {
    const double expected = ringing(stiffness, 2, 600);
    for (const double wind : {2.0, 5.0}) {
      EXPECT_LT(ringing(stiffness, wind, 0), 3 * expected) << stiffness << " N/m, " << wind << " m/s";
    }
  }
}

// --- T7 in time, T15 ---

TEST(ChainInTime, SwingsAtItsFirstFrequency) {
  // T7: f1 = 7.691559 Hz. The scheme's own frequency is w' = 2 asin(w dt / 2) / dt; at dt = 1e-4 s that is
  // 1 + (w dt)^2/24 = 1 + 1e-6 of w. Zero crossings of the middle mass, interpolated, over 10 periods.
  Particles<double> chain = test::flat_sheet<double>(2, 66, {65, 1});
  chain.mass.fill(1e-3);
  chain.inverse_mass.fill(1e3);
  for (int r : {0, 1}) chain.inverse_mass.at(r, 0) = chain.inverse_mass.at(r, 65) = 0;
  each_node(chain.grid(),
            [&](int r, int c) { chain.position.x.at(r, c) += 1e-3 * std::sin(c * std::numbers::pi / 65); });
  Material material = without_springs();
  material.structural = 1000;
  Rig<double> rig(std::move(chain), {65, 1}, material, Discretization::paper, {},
                  SymplecticEulerDescription{1, 0.9});
  const double dt = 1e-4, home = -32.5 + 32;
  std::vector<double> crossings;
  double before = rig.particles.position.x.at(0, 32) - home;
  for (int step = 1; crossings.size() < 21; ++step) {
    ASSERT_LT(step, 20'000);
    rig.advance(step * dt, dt);
    const double now = rig.particles.position.x.at(0, 32) - home;
    if (before * now <= 0) crossings.push_back((step - now / (now - before)) * dt);
    before = now;
  }
  const double hertz = 10 / (crossings.back() - crossings.front());
  EXPECT_NEAR(hertz / 7.691559, 1.0, 5e-6);
}

TEST(FreeCloth, KeepsLinearAndAngularMomentum) {
  // T15: random velocities, springs only. Equal and opposite forces along the springs: symplectic Euler keeps
  // both momenta to rounding. 100 substeps, forces up to 1e3 N on 289 nodes: 100 * 289 * 1e3 N * 1e-4 s *
  // 1e-16 = 3e-10 at worst.
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
    test::share_mass(sheet, 0.4, d);
    test::randomise(sheet.velocity, -3, 3, 4);
    const Vec3 momentum = linear_momentum(sheet), spin = angular_momentum(sheet);
    Rig<double> rig(std::move(sheet), {2, 2}, Material{}, d, {}, SymplecticEulerDescription{100, 0.9});
    rig.advance(0, kFrame);
    EXPECT_GT(test::largest_difference(rig.particles.velocity, VectorField<double>(rig.particles.grid())),
              0.5);
    EXPECT_LT((linear_momentum(rig.particles) - momentum).norm(), 3e-10);
    EXPECT_LT((angular_momentum(rig.particles) - spin).norm(), 3e-10);
  }
}

}  // namespace
}  // namespace weft
