// strain_damping: a mode of angular frequency w decays at tau w^2 / 2, a body that turns or flies does not.
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "methods.h"
#include "scene/scene.h"

namespace weft::test {
namespace {

using Damped = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Damped, ::testing::ValuesIn(kMethods), name_of_case);

/// What a method's step of h makes of y'' = -w^2 (y + tau y'): the rate of decay, 1/s, of its principal root
/// z = 1/s, from the characteristic equation of each, by Newton's method from s = exp(-i w h).
double decay(Method method, double w, double tau, double h) {
  using Number = std::complex<double>;
  const auto equation = [=](Number s) {
    const Number difference = 1.0 - s;
    if (method == Method::symplectic_euler)
      return difference * difference + w * w * h * h * s * (1.0 + tau / h * difference);
    const Number rate = method == Method::bdf2 ? (3.0 - 4.0 * s + s * s) / 2.0 : difference;
    return rate * rate + w * w * h * h * (1.0 + tau / h * difference);
  };
  Number s = std::exp(Number(0, -w * h));
  for (int i = 0; i < 20; ++i) {
    constexpr double kStep = 1e-6;
    s -= equation(s) * kStep / (equation(s + kStep) - equation(s));
  }
  return std::log(std::abs(s)) / h;
}

// The first mode of T7's chain of 64 masses along itself, f = 7.691559 Hz, tau such that it loses 12 % a
// period.
TEST_P(Damped, ChainAlongItself) {
  constexpr int kMasses = 64;
  constexpr double k = 1000, m = 1e-3;
  const double w = 2 * std::sqrt(k / m) * std::sin(std::numbers::pi / (2 * (kMasses + 1)));
  const double tau = 0.04 / w, expected = tau * w * w / 2;
  Particles<double> sheet = flat_sheet<double>(2, kMasses + 2, {65, 1});
  const auto mode = [](int c) { return std::sin(std::numbers::pi * c / (kMasses + 1)); };
  each_node(sheet.grid(), [&](int r, int c) {
    sheet.mass.at(r, c) = m;
    const bool held = c == 0 || c == kMasses + 1;
    sheet.inverse_mass.at(r, c) = held ? 0 : 1 / m;
    if (!held) set(sheet.position, r, c, get(sheet.position, r, c) + Vec3(1e-3 * mode(c), 0, 0));
  });
  const double middle = get(sheet.position, 0, 32).x() - 1e-3 * mode(32);
  constexpr int kSteps = 400, kPeriods = 5;
  const double h = 2 * std::numbers::pi / w / kSteps;
  const int substeps = GetParam() == Method::xpbd ? 40 : 1;
  Rig<double> rig(std::move(sheet), {65, 1}, strands(k), Discretization::paper, {StrainDampingEffect{tau}},
                  stepping(GetParam(), substeps));
  double first = 0, last = 0;  // sums over a period
  for (int step = 0; step < (kPeriods + 1) * kSteps; ++step) {
    const double x = get(rig.particles.position, 0, 32).x() - middle;
    const double reached = std::hypot(x, get(rig.particles.velocity, 0, 32).x() / w);
    if (step < kSteps) first += reached;
    if (step >= kPeriods * kSteps) last += reached;
    rig.advance(step * h, h);
  }
  const double measured = std::log(first / last) / (kPeriods * kSteps * h);
  // The method's own decay, of which implicit Euler and its kind have some undamped: w^2 h / 2, 40 % more at
  // one substep. XPBD has projected each spring once, far from all of them at once.
  const double own = decay(GetParam(), w, tau, h / substeps);
  EXPECT_NEAR(measured / own, 1, GetParam() == Method::xpbd ? 0.05 : 1e-3);
  const double undamped = decay(GetParam(), w, 0, h / substeps);
  EXPECT_NEAR((own - undamped) / expected, 1, 0.02);
}

/// A free sheet that flies and turns in its plane about its centre at 6 rad/s, as if it were rigid.
Rig<double> spinning(Method method, const std::vector<EffectDescription>& effects) {
  const int substeps = method == Method::symplectic_euler ? 0 : 20;
  Rig<double> rig = sheet_rig<double>(9, 9, stepping(method, substeps, 3), effects);
  rig.cloth.material.damping = 0.1;  // over 0.1 kg/m2: 1/s
  each_node(rig.particles.grid(), [&](int r, int c) {
    set(rig.particles.velocity, r, c,
        Vec3(1, -2, 3) + Vec3(0, 0, 6).cross(get(rig.particles.position, r, c)));
  });
  return rig;
}

// In a second Eq. 3 takes 1 - 1/e of all motion; the strain damping nothing of the flight, and of the turning
// what the method itself takes.
TEST_P(Damped, SpinningSheetKeepsItsMotion) {
  const auto after_a_second = [](Rig<double> rig) {
    for (int n = 0; n < 60; ++n) rig.advance(n * kFrame, kFrame);
    const Vec3 flight = linear_momentum(rig.particles) / 0.4;
    Vec3 spin = angular_momentum(rig.particles);
    spin -= 0.4 * centre(rig.particles).cross(flight);
    return std::pair(flight, spin.z());
  };
  const auto [flight, spin] = after_a_second(spinning(GetParam(), {}));
  const auto [damped_flight, damped_spin] =
      after_a_second(spinning(GetParam(), {StrainDampingEffect{0.005}}));
  EXPECT_LT((damped_flight - Vec3(1, -2, 3)).norm(), 1e-9);
  EXPECT_NEAR(damped_spin / spin, 1, 1e-3);
  const double first = angular_momentum(spinning(GetParam(), {}).particles).z();
  const bool kept = GetParam() == Method::symplectic_euler;
  EXPECT_NEAR(damped_spin / first, 1, kept ? 1e-9 : 0.1);  // the others lose some, damped or not
  if (GetParam() == Method::symplectic_euler) {
    EXPECT_NEAR(after_a_second(spinning(GetParam(), {DampingEffect{}})).second / first, std::exp(-1.0), 2e-3);
  }
}

/// J that a hide which falls onto a log still has after 0.6 s, when all of it lies and swings there, above
/// what it has at rest.
double energy_of_a_landed_hide(const IntegratorDescription& method, double rate) {
  SimulationDescription scene = std::get<scene::Scene>(scene::load("hide")).simulation;
  scene.cloths[0].min_level = scene.cloths[0].max_level = scene.cloths[0].initial_level = 4;
  scene.integrator = method;
  scene.time_step = 1 / rate;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 0.6 * rate; ++step) simulation.step();
  constexpr double kAtRest = 19.23;  // J, as it lies after half a minute, by each method to 0.01
  const ClothReport report = simulation.report(0);
  return report.kinetic_energy + report.potential_energy - kAtRest;
}

// The ledger's books of what dampers take must be those of the step as it ended: else its changes of the
// motion stop what lands. Symplectic Euler has no ledger, and steps short enough for all of the motion.
TEST(StrainDamping, LeavesAHideThatLandsOnALogItsMotion) {
  const double true_energy = energy_of_a_landed_hide(SymplecticEulerDescription{}, 60);
  EXPECT_GT(true_energy, 3) << "J; of 10 that it fell by";
  for (const double rate : {60.0, 240.0}) {
    EXPECT_NEAR(energy_of_a_landed_hide(Bdf2Description{}, rate), true_energy, 0.25 * true_energy) << rate;
    EXPECT_NEAR(energy_of_a_landed_hide(BackwardEulerDescription{}, rate), true_energy, 0.25 * true_energy)
        << rate;
  }
}

}  // namespace
}  // namespace weft::test
