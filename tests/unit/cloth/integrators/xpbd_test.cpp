// XPBD: its sweep against the plainest loop, one oscillator (T3, T4), statics (T9), momentum (T15),
// stability.
#include "cloth/integrators/xpbd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <vector>

#include "cloth/sheet/diagnostics.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::hung_rig;
using test::kFrame;
using test::ListedSpring;
using test::Rig;
using test::set;
using test::sheet_rig;
using test::without_springs;

// --- The sweep ---

/// One projection of one spring, as Macklin et al. 2016 write it: delta lambda = -C / (w_i + w_j + alpha /
/// h^2).
void project_plainly(const ListedSpring& spring, double h, Particles<double>& p) {
  const double wi = p.inverse_mass.at(spring.r0, spring.c0), wj = p.inverse_mass.at(spring.r1, spring.c1);
  const Vec3 ri = p.position_at(spring.r0, spring.c0), rj = p.position_at(spring.r1, spring.c1);
  const Vec3 d = ri - rj;
  const double lambda = -(d.norm() - spring.rest_length) / (wi + wj + 1 / (spring.stiffness * h * h));
  set(p.position, spring.r0, spring.c0, ri + wi * lambda * d.normalized());
  set(p.position, spring.r1, spring.c1, rj - wj * lambda * d.normalized());
}

/// Which colour a spring has: by the row of its first end, or by its column if it lies in a row.
int colour_of(const ListedSpring& spring) {
  const int rows = spring.r1 - spring.r0;
  return rows == 0 ? spring.c0 / (spring.c1 - spring.c0) % 2 : spring.r0 / rows % 2;
}

TEST(XpbdSweep, IsThatOfAPlainLoopOverColouredSprings) {
  // From random positions, with two nodes held, at all the ways a row can end: the same arithmetic but for
  // the order within a sum, 12 colours of corrections of up to 1 m. Rounding 1e-16 each, enlarged by springs
  // that start almost collapsed.
  const double h = 0.01;
  for (const auto& [rows, cols] : std::vector<std::pair<int, int>>{
           {2, 2}, {2, 3}, {3, 2}, {5, 4}, {4, 5}, {5, 7}, {9, 9}, {7, 10}, {10, 11}, {17, 12}, {33, 66}}) {
    Rig<double> rig = hung_rig<double>(rows, cols, XpbdDescription{1}, {});
    test::randomise(rig.particles.position, -1, 1, 5);
    Particles<double> plain = rig.particles;
    const auto& families = rig.springs().families();
    for (auto family = families.rbegin(); family != families.rend(); ++family) {
      for (int colour : {0, 1}) {
        for (const ListedSpring& spring : test::list_springs({*family}, plain.grid())) {
          if (colour_of(spring) == colour) project_plainly(spring, h, plain);
        }
      }
    }
    rig.advance(0, h);
    EXPECT_LT(test::largest_difference(rig.particles.position, plain.position), 1e-12)
        << rows << " x " << cols;
  }
}

TEST(XpbdSweep, SpringsOfOneColourShareNoNode) {
  const Springs<double> springs(Material{}, Discretization::continuum, {2, 2}, Grid::with_nodes(10, 11));
  for (const SpringFamily& family : springs.families()) {
    for (int colour : {0, 1}) {
      Field<double> used(Grid::with_nodes(10, 11));
      for (const ListedSpring& spring : test::list_springs({family}, used.grid())) {
        if (colour_of(spring) != colour) continue;
        EXPECT_EQ(used.at(spring.r0, spring.c0)++, 0);
        EXPECT_EQ(used.at(spring.r1, spring.c1)++, 0);
      }
    }
  }
}

// --- One spring ---

/// Two nodes 1 m apart along x, twice; the left ones held, the right ones alike, 1 kg on a spring of k N/m.
Rig<double> oscillator(double k, const std::vector<EffectDescription>& effects = {}) {
  Particles<double> sheet = test::flat_sheet<double>(2, 2, {1, 1});
  for (int r : {0, 1}) sheet.inverse_mass.at(r, 0) = 0;
  Material material = without_springs();
  material.structural = k;
  return {std::move(sheet), {1, 1}, material, Discretization::paper, effects, XpbdDescription{1}};
}

TEST(XpbdOscillator, IsBackwardEulers) {
  // One spring, one projection: x' = (x + h v) / (1 + w^2 h^2), v' = (x' - x) / h, which is backward Euler:
  // x_n = Re((1 - i w h)^-n). With 60 steps a period, T3: 0.720942 of the amplitude is left after 60 steps'
  // decay (1 + w^2 h^2)^-30, T4: the frequency is arctan(w h) / (w h) = 0.996368.
  const double wh = 2 * std::numbers::pi / 60, h = 0.01, k = wh * wh / (h * h);
  Rig<double> rig = oscillator(k);
  const double home = rig.particles.position.x.at(0, 1);
  for (int r : {0, 1}) rig.particles.position.x.at(r, 1) += 0.1;
  for (int n = 1; n <= 120; ++n) {
    rig.advance(0, h);
    const double expected = 0.1 * std::pow(std::complex<double>(1, -wh), -n).real();
    ASSERT_NEAR(rig.particles.position.x.at(0, 1) - home, expected, 1e-14) << n;
  }
  EXPECT_NEAR(std::pow(1 + wh * wh, -30), 0.720942, 1e-6);
  EXPECT_NEAR(std::atan(wh) / wh, 0.996368, 1e-6);
}

TEST(XpbdOscillator, RestsWhereTheSpringBearsTheLoad) {
  // 1 kg pulled along x by 9.81 m/s2 on 50 N/m: 0.1962 m, whatever the substep.
  Rig<double> rig = oscillator(50, {GravityEffect{{9.81, 0, 0}}});
  const double home = rig.particles.position.x.at(0, 1);
  for (int n = 0; n < 2000; ++n) rig.advance(0, 0.1);
  EXPECT_NEAR(rig.particles.position.x.at(0, 1) - home, 0.1962, 1e-12);
}

// --- Free sheets ---

template <class Real>
class XpbdFreeFall : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(XpbdFreeFall, Scalars);

TYPED_TEST(XpbdFreeFall, FallsAsEquation6SaysWithItsSpringsAtRest) {
  // T1 with 20 substeps: y = -g h^2 n (n + 1) / 2, n = 1200, h = 1/1200 s: -4.9090875 m. A float position
  // rounds to 4.8e-7 m near 5 m; the springs take that for strain, and a node's velocity follows: one such
  // step is 0.7 m/s2, its neighbours' come on top. Over 60 steps that adds up to 1e-4 m.
  Rig<TypeParam> rig = sheet_rig<TypeParam>(17, 17, XpbdDescription{20}, {GravityEffect{}});
  const Particles<TypeParam> start = rig.particles;
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  constexpr bool kSingle = std::is_same_v<TypeParam, float>;
  const double most_apart = kSingle ? 3e-4 : 1e-11, most_pull = kSingle ? 3.0 : 1e-7;
  each_node(start.grid(), [&](int r, int c) {
    const Vec3 fall = rig.particles.position_at(r, c) - start.position_at(r, c);
    EXPECT_LT((fall - Vec3(0, -4.9090875, 0)).norm(), most_apart);
    EXPECT_LT((get(rig.particles.acceleration, r, c) - Vec3(0, -9.81, 0)).norm(), most_pull);
  });
}

TEST(XpbdFreeCloth, KeepsLinearMomentumToRoundingAndAngularMomentumToFirstOrder) {
  // T15: random velocities, springs only. Each projection moves its ends by opposite m dr: linear momentum is
  // kept but for rounding, 1e-16 m a projection, 289 nodes of 1.4e-3 kg, h = 1.7e-4 s, 600 colours: 1e-10 at
  // worst. The impulses act along the springs as they are after the prediction, not as they were at the
  // substep's start: angular momentum is off by O(h), as in backward Euler.
  const auto errors = [](int substeps) {
    Rig<double> rig = sheet_rig<double>(17, 17, XpbdDescription{substeps});
    test::randomise(rig.particles.velocity, -0.3, 0.3, 4);
    const Vec3 momentum = linear_momentum(rig.particles), spin = angular_momentum(rig.particles);
    rig.advance(0, kFrame);
    return std::pair((linear_momentum(rig.particles) - momentum).norm(),
                     (angular_momentum(rig.particles) - spin).norm());
  };
  const auto [linear, angular] = errors(200);
  EXPECT_LT(linear, 1e-10);
  EXPECT_GT(angular, 1e-8);
  EXPECT_NEAR(angular / errors(400).second, 2.0, 0.3);
}

TEST(XpbdDamping, DragFasterThanTheSubstepStopsAtTheTerminalVelocity) {
  // Rate 100/s, h = 0.1 s: an explicit step would swing nine times as far to the other side. v = g / rate.
  Material material = without_springs();
  material.damping = 10;  // over 0.1 kg/m2
  Rig<double> rig = sheet_rig<double>(9, 9, XpbdDescription{1}, {GravityEffect{}, DampingEffect{}}, material);
  rig.particles.velocity.x.fill(50);
  for (int step = 0; step < 3; ++step) {
    rig.advance(step * 0.1, 0.1);
    EXPECT_LT((rig.particles.velocity_at(4, 4) - Vec3(0, -0.0981, 0)).norm(), 1e-12) << step;
  }
}

// --- How many substeps ---

TEST(XpbdSubsteps, AreAsShortInStepsOfAnyLength) {
  // 1/2400 s by default; 0.0167 s is meant as 1/60 s.
  for (const auto& [dt, expected] : std::vector<std::pair<double, int>>{
           {1.0 / 60, 40}, {0.0167, 40}, {1.0 / 30, 80}, {1.0 / 15, 160}, {1.0 / 120, 20}, {1e-5, 1}}) {
    EXPECT_EQ(substeps(XpbdDescription{}, dt), expected) << dt;
    EXPECT_EQ(sheet_rig<double>(3, 3, XpbdDescription{}).advance(0, dt).substeps, expected) << dt;
  }
  EXPECT_EQ(substeps({0, 0.01}, 0.1), 10);
  EXPECT_EQ(substeps({0, 0.01}, 0.1009), 10);
  EXPECT_EQ(substeps({0, 0.01}, 0.1011), 11);
  EXPECT_EQ(substeps({7, 0.01}, 0.1), 7);
}

TEST(XpbdSubsteps, DampedSpringsBearTheirLoadFromOneCountToTheNext) {
  // Hung, stretched by rho g L / Y = 0.1 at the top, and at rest; four times the substeps then, as a pinned
  // node is given a speed, which it has no use for. What moves it now is that 15/16 of the substeps' excess,
  // g h^2 (N^2 - N - 1) / 2, go. Its damped springs alone would have let go of 1 - e^(-t / tau) of that after
  // t; they have nodes to move as well. Multipliers that are 16 times too large lift it by 3.8 times as much.
  Material material = without_springs();
  material.structural = 19.62;
  material.damping = 0.5;
  Rig<double> rig = sheet_rig<double>(17, 5, XpbdDescription{},
                                      {GravityEffect{}, DampingEffect{}, StrainDampingEffect{0.2}}, material);
  for (int c = 0; c < 5; ++c) rig.particles.inverse_mass.at(0, c) = 0;
  for (int step = 0; step < 1200; ++step) rig.advance(step * kFrame, kFrame);
  const double before = rig.particles.position_at(16, 2).y();
  rig.particles.velocity.z.at(0, 0) = 1000;
  EXPECT_EQ(rig.advance(0, kFrame).substeps, 160);
  const double excess = 9.81 * kFrame * kFrame / 1600 * (256 - 16 - 1) / 2;
  EXPECT_LT(std::abs(rig.particles.position_at(16, 2).y() - before), excess * (1 - std::exp(-kFrame / 0.2)));
}

// --- T9: a sheet hung by its top edge ---

/// How much longer than 2 m the hung sheet of 16 cells is once at rest.
double hung_stretch(int substeps, Material material) {
  material.damping = 0.5;
  Rig<double> rig =
      sheet_rig<double>(17, 5, XpbdDescription{substeps}, {GravityEffect{}, DampingEffect{}}, material);
  for (int c = 0; c < 5; ++c) rig.particles.inverse_mass.at(0, c) = 0;
  for (int step = 0; step < 400; ++step) rig.advance(step * kFrame, kFrame);
  EXPECT_LT(kinetic_energy(rig.particles), 1e-16);
  return rig.particles.position_at(0, 2).y() - rig.particles.position_at(16, 2).y() - 2;
}

TEST(XpbdHungSheet, StretchesByItsWeightAndByTheSubstep) {
  // At rest each spring passes on its load F once a substep: F h^2 = (l - l0) / (w_i + w_j + 1 / (k h^2)). A
  // spring projected last is left at l - l0 = F/k; one of the first colour has F h^2 (w_i + w_j) more, but
  // for the g h^2 of the prediction at the top. Over N = 16 cells of springs along v alone: rho g L^2 / (2 Y)
  // + g h^2 (N^2 - N - 1) / 2, T9's 3.924e-4 m and, with n = 4, 0.0203519 m.
  Material material = without_springs();
  material.structural = 5000;
  for (int n : {4, 8, 40}) {
    const double h = kFrame / n, excess = 9.81 * h * h * (256 - 16 - 1) / 2;
    EXPECT_NEAR(hung_stretch(n, material), 3.924e-4 + excess, 1e-8) << n;
  }
}

TEST(XpbdHungSheet, ApproachesTheSpringsOwnStretchSlow) {
  // With all springs: shear and bending springs carry some of the load and help to pass it on. The excess
  // falls with the square of the substep all the same; what the springs themselves allow is what two counts
  // extrapolate to, within 1 % of its own size of the answer at twice the finer count.
  const double coarse = hung_stretch(20, Material{}), fine = hung_stretch(40, Material{}),
               finest = hung_stretch(80, Material{});
  const double limit = fine - (coarse - fine) / 3;
  EXPECT_LT(limit, 3.924e-4);
  EXPECT_GT(limit, 0.8 * 3.924e-4);
  EXPECT_NEAR(finest - (fine - finest) / 3, limit, 0.01 * limit);
}

}  // namespace
}  // namespace weft
