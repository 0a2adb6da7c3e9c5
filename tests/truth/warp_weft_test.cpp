// Warp and weft of different stiffness: how far each stretches, how fast each swings.
#include "methods.h"

namespace weft::test {
namespace {

constexpr int kCells = 16;
constexpr Stiffness kUneven{6000, 1500};

/// A square metre of threads held by its first column, or row, with its nodes `out` of place along the
/// threads there.
template <class Out>
Rig<double> held_threads(bool warp, const std::vector<EffectDescription>& effects,
                         const IntegratorDescription& stepping, Out out) {
  Particles<double> sheet = flat_sheet<double>(kCells + 1, kCells + 1, {1, 1});
  Material material = strands(0);
  material.structural = kUneven;
  share_mass(sheet, material.density, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const int along = warp ? c : r;
    if (along == 0) sheet.inverse_mass.at(r, c) = 0;
    (warp ? sheet.position.x : sheet.position.y).at(r, c) += (warp ? 1 : -1) * out(along);
  });
  return {std::move(sheet), {1, 1}, material, Discretization::continuum, effects, stepping};
}

/// How far its end is from the held one, less a metre.
double stretch(const Rig<double>& rig, bool warp) {
  const Vec3 end = get(rig.particles.position, warp ? kCells / 2 : kCells, warp ? kCells : kCells / 2);
  const Vec3 held = get(rig.particles.position, warp ? kCells / 2 : 0, warp ? 0 : kCells / 2);
  return (end - held).norm() - 1;
}

// Hung by one end a sheet of length L is longer by rho g L^2 / (2 Y), whatever the number of cells.
TEST(WarpAndWeft, StretchUnderTheirWeightAsTheirOwnStiffnessSays) {
  constexpr double kDensity = 0.1, kGravity = 9.81;
  for (const bool warp : {true, false}) {
    const Vec3 down = warp ? Vec3(kGravity, 0, 0) : Vec3(0, -kGravity, 0);
    Rig<double> rig = held_threads(warp, {GravityEffect{down}}, stepping(Method::backward_euler, 1, 3),
                                   [](int) { return 0.0; });
    for (int n = 0; n < 100; ++n) rig.advance(n * 0.1, 0.1);
    const double stiffness = warp ? kUneven.warp : kUneven.weft;
    EXPECT_NEAR(stretch(rig, warp), kDensity * kGravity / (2 * stiffness), 1e-9) << (warp ? "warp" : "weft");
  }
}

using WarpAndWeftOf = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, WarpAndWeftOf, ::testing::ValuesIn(kMethods), name_of_case);

// Held at one end threads swing along themselves by 2 sqrt(Y / rho) / h sin(pi / (4 N)) (Ashcroft and Mermin,
// Solid State Physics, 1976, chapter 22; the last node, of half a cell, makes the free end a crest).
TEST_P(WarpAndWeftOf, SwingAsTheirOwnStiffnessSays) {
  const double h = 1.0 / kCells;
  for (const bool warp : {true, false}) {
    const double stiffness = warp ? kUneven.warp : kUneven.weft;
    const double w = 2 * std::sqrt(stiffness / 0.1) / h * std::sin(std::numbers::pi / (4 * kCells));
    const double period = 2 * std::numbers::pi / w, step = period / 400;
    const int substeps = GetParam() == Method::symplectic_euler ? 1 : GetParam() == Method::xpbd ? 10 : 1;
    Rig<double> rig = held_threads(warp, {}, stepping(GetParam(), substeps), [](int along) {
      return 1e-5 * std::sin(std::numbers::pi * along / (2 * kCells));
    });
    Crossings signal(step);
    for (int n = 0; signal.count() < 4 && n < 4000; ++n) {
      signal.add(stretch(rig, warp));
      rig.advance(n * step, step);
    }
    // XPBD has projected each spring once, in turn.
    EXPECT_NEAR(signal.frequency() * period, relative_frequency(GetParam(), w, step / substeps),
                GetParam() == Method::xpbd ? 0.02 : 5e-4)
        << (warp ? "warp" : "weft");
  }
}

}  // namespace
}  // namespace weft::test
