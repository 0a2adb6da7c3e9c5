// Plates: a vibrating one (T13), bent strips (T11, Euler and Bernoulli, Peirce), wrinkles.
#include "methods.h"

namespace weft::test {
namespace {

using Plates = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Plates, ::testing::ValuesIn(kMethods), name_of_case);

constexpr double kPi = std::numbers::pi;

Material bent(double structural, const Rigidity& rigidity, double density = 0.1) {
  Material material = strands(structural, density);
  material.rigidity = rigidity;
  return material;
}

/// Frequency of mode (m, n) of a simply supported square plate of 1 m, 0.1 kg/m2, relative to
/// pi/2 (m^2 + n^2) sqrt(B/rho) at B = 1e-3, with so many cells a side.
double supported_plate(Method method, const Rigidity& rigidity, int m, int n, int cells, double h,
                       int substeps) {
  Particles<double> sheet = flat_sheet<double>(cells + 1, cells + 1, {1, 1});
  share_mass(sheet, 0.1, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const bool rim = r == 0 || c == 0 || r == cells || c == cells;
    if (rim) sheet.inverse_mass.at(r, c) = 0;
    if (!rim)
      sheet.position.z.at(r, c) = 1e-3 * std::sin(m * kPi * c / cells) * std::sin(n * kPi * r / cells);
  });
  Rig<double> rig(std::move(sheet), {1, 1}, bent(0, rigidity), Discretization::continuum,
                  {PlateBendingEffect{}}, stepping(method, substeps));
  Crossings signal(h);
  const int r = cells / (2 * n), c = cells / (2 * m);  // on a crest
  for (int step = 0; signal.count() < 3 && step < 100000; ++step) {
    signal.add(rig.particles.position.z.at(r, c));
    rig.advance(step * h, h);
  }
  return signal.frequency() / (kPi / 2 * (m * m + n * n) * std::sqrt(1e-3 / 0.1));
}

// T13: f11 = 0.314159 Hz. The lattice's own is (sin x / x)^2 of it, x = pi/(2N): its second differences
// squared.
TEST_P(Plates, SimplySupported) {
  constexpr double kFrequency = 0.314159;
  EXPECT_NEAR(kPi / 2 * 2 * std::sqrt(1e-3 / 0.1), kFrequency, 1e-6);
  constexpr int kCells = 16;
  const double h = 1 / (400 * kFrequency);
  const int substeps = GetParam() == Method::symplectic_euler ? 0 : GetParam() == Method::xpbd ? 10 : 1;
  const double x = kPi / (2 * kCells), lattice = std::pow(std::sin(x) / x, 2);
  const double w = 2 * kPi * kFrequency * lattice;
  const double own_step = substeps > 0 ? h / substeps : 1e-4;  // symplectic Euler's is finer still
  const double measured = supported_plate(GetParam(), {1e-3, 1e-3, 1e-3}, 1, 1, kCells, h, substeps);
  // XPBD has projected each stencil once, in turn.
  EXPECT_NEAR(measured, lattice * relative_frequency(GetParam(), w, own_step),
              GetParam() == Method::xpbd ? 0.02 : 2e-4);
}

// Anisotropic: w^2 rho = pi^4 (B_u m^4 + B_v n^4 + 2 B_t m^2 n^2) (Timoshenko and Woinowsky-Krieger, Theory
// of Plates and Shells, 1959, section 86).
TEST(Plate, FrequenciesOfAnUnevenOne) {
  constexpr Rigidity kUneven{2e-3, 5e-4, 1e-3};
  for (const auto& [m, n] : {std::pair(1, 1), std::pair(2, 1), std::pair(1, 2)}) {
    const double square =
        kUneven.u * std::pow(m, 4) + kUneven.v * std::pow(n, 4) + 2 * kUneven.twist * m * m * n * n;
    const double expected = std::sqrt(square / 1e-3) / (m * m + n * n);
    // The grid's error of the shorter wave: 1 - (sin x / x)^2 with x = 2 pi / (2 * 32) is 0.32 %.
    EXPECT_NEAR(supported_plate(Method::bdf2, kUneven, m, n, 32, 0.01, 1) / expected, 1, 5e-3)
        << m << ", " << n;
  }
}

// T18: the error falls with the square of the spacing.
TEST(Plate, FrequencyConvergesWithLevel) {
  const auto error = [](int cells) {
    return 1 - supported_plate(Method::bdf2, {1e-3, 1e-3, 1e-3}, 1, 1, cells, 0.003, 1);
  };
  const double coarse = error(8), middle = error(16), fine = error(32);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.1);
}

/// A strip of 1 m x 0.1 m clamped at its left end under its weight, at rest: rho g L^3 / B = `load`. The
/// clamp is beyond the strip: its first two columns are held.
struct Tip {
  double reach, drop;  ///< relative to its length
};
Tip cantilever(double load, int cells) {
  constexpr double kDensity = 0.1, kGravity = 9.81, kRigidity = 1e-3;
  const double length = std::cbrt(load * kRigidity / (kDensity * kGravity));
  const double cell = length / cells;
  const Vec2 size(length + cell, 4 * cell);
  Particles<double> sheet = flat_sheet<double>(5, cells + 2, size);
  share_mass(sheet, kDensity * size.x() * size.y(), Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 p = get(sheet.position, r, c);
    set(sheet.position, r, c, {p.x() + size.x() / 2 - cell, 0, p.y()});
    if (c < 2) sheet.inverse_mass.at(r, c) = 0;
  });
  // Hardly stretched: 1e-6 and less.
  Rig<double> rig(std::move(sheet), size, bent(1e6, {kRigidity, kRigidity, kRigidity}, kDensity),
                  Discretization::continuum, {GravityEffect{}, PlateBendingEffect{}},
                  stepping(Method::backward_euler, 1, 3));
  // Long steps of backward Euler damp the swing to 1e-9 of it.
  constexpr double kStep = 0.1;
  for (int n = 0; n < 100; ++n) rig.advance(n * kStep, kStep);
  const Vec3 tip = get(rig.particles.position, 2, cells + 1);
  return {tip.x() / length, -tip.y() / length};
}

// Euler and Bernoulli: a small load bends the tip down by rho g L^4 / (8 B).
TEST(Cantilever, ASmallLoadBendsItAsTheBeamSays) {
  // The discrete beam's own deflection is (1 + 1/N^2 ...) of it; the strip's large-deflection term is of the
  // load's square, 1e-6.
  EXPECT_NEAR(cantilever(1e-3, 32).drop / (1e-3 / 8), 1, 3e-3);
}

// T11, the heavy elastica: load 5 leaves the tip at 0.846657 and 0.495905 of the length; order 2.
TEST(Cantilever, HangsAsTheHeavyElastica) {
  const Tip middle = cantilever(5, 16), fine = cantilever(5, 32);
  EXPECT_NEAR(fine.reach, 0.846657, 2e-3);
  EXPECT_NEAR(fine.drop, 0.495905, 2e-3);
  EXPECT_NEAR(std::log2((middle.drop - 0.495905) / (fine.drop - 0.495905)), 2, 0.3);
}

// Peirce, The "handle" of cloth as a measurable quantity, J. Textile Institute 21, 1930: a strip whose chord
// hangs at 41.5 degrees overhangs by twice its bending length (B / (rho g))^(1/3), that is, at a load of 8.
TEST(Cantilever, OverhangIsPeircesBendingLength) {
  const Tip tip = cantilever(8, 32);
  // Peirce's formula (cos(t/2) / (8 tan t))^(1/3) is an approximation: 0.509 instead of 0.5 at 41.5 degrees.
  EXPECT_NEAR(std::atan2(tip.drop, tip.reach) * 180 / kPi, 41.5, 1);
}

// Cerda and Mahadevan, Geometry and physics of wrinkling, Phys. Rev. Lett. 90, 2003: a strip of length L
// under the tension T that is narrowed wrinkles with the wavelength 2 sqrt(pi) (B/T)^(1/4) sqrt(L). Of warp
// and weft alone, and narrowed by a third more than the least that buckles it, which leaves no other
// wavelength.
TEST(Wrinkles, HaveTheWavelengthOfCerdaAndMahadevan) {
  constexpr int kRows = 65, kCols = 17, kWaves = 8;
  constexpr double kTension = 10, kStiffness = 5000, kWavelength = 1.0 / kWaves;
  const double rigidity = kTension * std::pow(kWavelength / (2 * std::sqrt(kPi)), 4);
  const double wave = 2 * kPi / kWavelength;
  // Least of B k^4 + T (pi/L)^2 over k^2: what the threads across have to be pressed with, N/m.
  const double critical = 2 * rigidity * wave * wave;
  const double narrowed = 1.3 * critical / kStiffness;
  Particles<double> sheet = flat_sheet<double>(kRows, kCols, {1 + kTension / kStiffness, 1 - narrowed});
  share_mass(sheet, 0.1, Discretization::continuum);
  BackwardEulerDescription solver;
  solver.tolerance = 1e-4;
  VectorField<double> noise(sheet.grid());
  randomise(noise, -1e-7, 1e-7, 1);
  each_node(sheet.grid(), [&](int r, int c) {
    const bool rim = r == 0 || c == 0 || r == kRows - 1 || c == kCols - 1;
    if (rim) sheet.inverse_mass.at(r, c) = 0;
    if (!rim) sheet.position.z.at(r, c) = noise.z.at(r, c);
  });
  Rig<double> rig(std::move(sheet), {1, 1}, bent(kStiffness, {0, rigidity, 0}), Discretization::continuum,
                  {PlateBendingEffect{}}, solver);
  for (int n = 0; n < 300; ++n) rig.advance(n * kFrame, kFrame);
  int turns = 0;
  double highest = 0;
  for (int r = 1; r + 1 < kRows; ++r) {
    const double here = rig.particles.position.z.at(r, kCols / 2),
                 below = rig.particles.position.z.at(r + 1, kCols / 2);
    highest = std::max(highest, std::abs(here));
    turns += (here < 0) != (below < 0) ? 1 : 0;
  }
  EXPECT_GT(highest, 1e-4);           // it wrinkles
  EXPECT_NEAR(turns, 2 * kWaves, 1);  // half waves; the held sides take their part of one
}

}  // namespace
}  // namespace weft::test
