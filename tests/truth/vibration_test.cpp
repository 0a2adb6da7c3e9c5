// Frequencies: a chain (T7), a hanging strip (T8), a stretched membrane (T12). Each method is held to the
// case's own frequency times what the method is known to make of it at this step (T4); what is left is the
// grid's error.
#include "methods.h"

namespace weft::test {
namespace {

using Vibration = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Vibration, ::testing::ValuesIn(kMethods), name_of_case);

/// Steps of h until the probe has crossed zero `crossings` times upwards.
template <class Probe>
double frequency(Rig<double>& rig, double h, int crossings, Probe probe) {
  Crossings signal(h);
  for (int step = 0; signal.count() < crossings && step < 100000; ++step) {
    signal.add(probe());
    rig.advance(step * h, h);
  }
  return signal.frequency();
}

// T7: fixed-fixed chain of 64 masses of 1 g, k = 1000 N/m, along itself: f1 = sqrt(k/m)/pi sin(pi/(2 (N+1))).
TEST_P(Vibration, ChainAlongItself) {
  constexpr int kMasses = 64;
  constexpr double k = 1000, m = 1e-3;
  const double expected =
      std::sqrt(k / m) / std::numbers::pi * std::sin(std::numbers::pi / (2 * (kMasses + 1)));
  EXPECT_NEAR(expected, 7.691559, 1e-6);

  Particles<double> sheet = flat_sheet<double>(2, kMasses + 2, {65, 1});
  each_node(sheet.grid(), [&](int r, int c) {
    sheet.mass.at(r, c) = m;
    const bool held = c == 0 || c == kMasses + 1;
    sheet.inverse_mass.at(r, c) = held ? 0 : 1 / m;
    const double mode = std::sin(std::numbers::pi * c / (kMasses + 1));
    if (!held) set(sheet.position, r, c, get(sheet.position, r, c) + Vec3(1e-3 * mode, 0, 0));
  });
  const double h = 1 / (400 * expected);
  const int substeps = GetParam() == Method::xpbd ? 10 : 1;
  Rig<double> rig(std::move(sheet), {65, 1}, strands(k), Discretization::paper, {},
                  stepping(GetParam(), substeps));
  const double middle = get(rig.particles.position, 0, 32).x() - 1e-3 * std::sin(std::numbers::pi * 32 / 65);
  const double measured =
      frequency(rig, h, 4, [&] { return get(rig.particles.position, 0, 32).x() - middle; });
  // A mode of the chain itself: no grid's error. XPBD has projected each spring once, far from all of them at
  // once, and so is softer.
  const double relative = relative_frequency(GetParam(), 2 * std::numbers::pi * expected, h);
  const double tolerance = GetParam() == Method::xpbd ? 1e-2 : 1e-5;
  EXPECT_NEAR(measured / expected, relative, tolerance);
}

// T8: a strip of 2 m hung by its top edge swings sideways in the mode J0(j01 sqrt(s/L)), s from its lower
// end, at j01/2 sqrt(g/L) (Bernoulli's hanging chain).
constexpr double kStripLength = 2, kFirstZero = 2.404825557695773;
constexpr int kStripRows = 33;
const double kStripFrequency = kFirstZero / 2 * std::sqrt(9.81 / kStripLength);

Rig<double> hanging_strip(const IntegratorDescription& stepping, double amplitude) {
  constexpr int kCols = 3;
  Particles<double> sheet = flat_sheet<double>(kStripRows, kCols, {0.125, kStripLength});
  share_mass(sheet, 0.1 * 0.125 * kStripLength, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    if (r == 0) sheet.inverse_mass.at(r, c) = 0;
    const double shape = std::cyl_bessel_j(0.0, kFirstZero * std::sqrt(1 - double(r) / (kStripRows - 1)));
    const Vec3 p = get(sheet.position, r, c);
    set(sheet.position, r, c, {p.x(), p.y(), r == 0 ? 0.0 : amplitude * shape});
  });
  return {std::move(sheet),          {0.125, kStripLength}, strands(1e4),
          Discretization::continuum, {GravityEffect{}},     stepping};
}

TEST_P(Vibration, HangingStrip) {
  EXPECT_NEAR(kStripFrequency / (2 * std::numbers::pi), 0.423831, 1e-6);
  constexpr double h = 1.0 / 240;
  const int substeps = GetParam() == Method::xpbd ? 20 : GetParam() == Method::symplectic_euler ? 0 : 1;
  Rig<double> rig = hanging_strip(stepping(GetParam(), substeps), 0.01);
  const double measured = 2 * std::numbers::pi * frequency(rig, h, 4, [&] {
                            return get(rig.particles.position, kStripRows - 1, 1).z();
                          });
  const double own_step = GetParam() == Method::backward_euler || GetParam() == Method::bdf2 ? h : 1e-9;
  // The grid's error is of second order, (pi/32)^2/24 for a sine and of that size here; XPBD's extra stretch
  // of 1e-3 m and the stretch itself, 2e-4 m, lengthen the strip by less than that.
  EXPECT_NEAR(measured / kStripFrequency, relative_frequency(GetParam(), kStripFrequency, own_step), 1e-3);
}

/// Share of its amplitude that a swinging strip has lost after `kPeriods` at 60 steps a second.
constexpr int kPeriods = 10;
const int kStepsAPeriod = static_cast<int>(std::round(2 * std::numbers::pi / kStripFrequency / kFrame));

double amplitude_lost(const IntegratorDescription& stepping, double amplitude) {
  Rig<double> rig = hanging_strip(stepping, amplitude);
  const auto reached = [&] {
    const Vec3 p = get(rig.particles.position, kStripRows - 1, 1);
    const Vec3 v = get(rig.particles.velocity, kStripRows - 1, 1);
    return std::hypot(p.z(), v.z() / kStripFrequency);
  };
  double first = 0, last = 0;  // sums over a period: what else swings along drops out
  for (int step = 0; step < (kPeriods + 1) * kStepsAPeriod; ++step) {
    if (step < kStepsAPeriod) first += reached();
    if (step >= kPeriods * kStepsAPeriod) last += reached();
    rig.advance(step * kFrame, kFrame);
  }
  return 1 - last / first;
}

// T3, T4: BDF2 loses 0.14 % in ten periods where backward Euler loses 75 %.
TEST(SwingingStrip, LosesWhatTheMethodTakes) {
  const auto expected = [](Method method) {
    return 1 - std::pow(std::abs(principal_root(method, kStripFrequency, kFrame)), kPeriods * kStepsAPeriod);
  };
  EXPECT_NEAR(expected(Method::bdf2), 0.00137, 1e-5);
  EXPECT_NEAR(expected(Method::backward_euler), 0.75272, 1e-5);
  // The strip's frequency is the grid's, 1e-3 off; a loss goes with its square or its fourth power.
  EXPECT_NEAR(amplitude_lost(solved_exactly<Bdf2Description>(1, 3), 0.01), expected(Method::bdf2), 1e-4);
  EXPECT_NEAR(amplitude_lost(solved_exactly<BackwardEulerDescription>(1, 3), 0.01),
              expected(Method::backward_euler), 1e-3);
}

// What loosely solved systems leave is taken from the motion: this is the tolerance to swing on with.
TEST(SwingingStrip, KeepsItsAmplitudeAtATolerance) {
  Bdf2Description stepping;
  stepping.tolerance = 0.001;
  for (const double amplitude : {0.1, 0.5}) EXPECT_LT(std::abs(amplitude_lost(stepping, amplitude)), 0.01);
}

// T12: a square membrane of 1 m under 10 N/m, 0.1 kg/m2: f11 = sqrt(T/rho)/2 sqrt(2).
TEST_P(Vibration, StretchedMembrane) {
  constexpr double kTension = 10, kStiffness = 1000;
  const double expected = std::sqrt(kTension / 0.1) / 2 * std::sqrt(2.0);
  EXPECT_NEAR(expected, 7.071068, 1e-6);
  constexpr int kCells = 16;
  // Rest length such that k (l - l0) / l = T.
  const double rest = 1 - kTension / kStiffness;
  Particles<double> sheet = flat_sheet<double>(kCells + 1, kCells + 1, {1, 1});
  share_mass(sheet, 0.1, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const bool rim = r == 0 || c == 0 || r == kCells || c == kCells;
    if (rim) sheet.inverse_mass.at(r, c) = 0;
    const double shape = std::sin(std::numbers::pi * r / kCells) * std::sin(std::numbers::pi * c / kCells);
    const Vec3 p = get(sheet.position, r, c);
    set(sheet.position, r, c, {p.x(), p.y(), rim ? 0.0 : 2e-4 * shape});
  });
  const double h = 1 / (400 * expected);
  const int substeps = GetParam() == Method::symplectic_euler ? 0 : GetParam() == Method::xpbd ? 10 : 1;
  Rig<double> rig(std::move(sheet), {rest, rest}, strands(kStiffness), Discretization::continuum, {},
                  stepping(GetParam(), substeps));
  const double measured =
      frequency(rig, h, 4, [&] { return get(rig.particles.position, kCells / 2, kCells / 2).z(); });
  // The lattice's own frequency, exactly: sin(pi/(2N))/(pi/(2N)).
  const double x = std::numbers::pi / (2 * kCells), lattice = std::sin(x) / x;
  const double w = 2 * std::numbers::pi * expected * lattice;
  EXPECT_NEAR(measured / expected,
              lattice * relative_frequency(GetParam(), w, substeps > 0 ? h / substeps : h),
              GetParam() == Method::xpbd ? 2e-3 : 2e-4);
}

}  // namespace
}  // namespace weft::test
