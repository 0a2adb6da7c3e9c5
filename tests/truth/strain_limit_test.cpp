// Sheets loaded beyond their limits, against the bilinear law by hand.
#include "methods.h"

namespace weft::test {
namespace {

using StrainLimit = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, StrainLimit, ::testing::ValuesIn(kMethods), name_of_case);

constexpr double kStiffening = 20;

/// Elongation under a tension, N/m, of a sheet of stiffness Y, N/m, that stiffens beyond `limit`.
double elongation(double tension, double stiffness, double limit) {
  const double beyond = std::max(0.0, tension - stiffness * limit);
  return std::min(tension / stiffness, limit) + beyond / (kStiffening * stiffness);
}

/// How much longer a sheet of 2 m, rho = 0.1 kg/m2 and Y = 20 N/m hangs under its own weight, m. The tension
/// rho g s at s m from the lower edge passes 20 N/m times 0.05 at s = 1.019 m.
double hung_stretch(bool along_u, Method method) {
  constexpr int kCells = 16, kSubsteps = 40, kAcross = 4;
  constexpr double kStiffness = 20, kDensity = 0.1;
  Material material = strands(kStiffness, kDensity);
  material.limit = {0.05, 0.05, 0.3, kStiffening};
  (along_u ? material.limit.weft : material.limit.warp) = 1;  // the other's limit has no part in it
  material.damping = 0.5;
  const int substeps = method == Method::symplectic_euler ? 0 : method == Method::xpbd ? kSubsteps : 1;
  const Vec3 down = along_u ? Vec3(9.81, 0, 0) : Vec3(0, -9.81, 0);
  const int rows = along_u ? kAcross + 1 : kCells + 1, cols = along_u ? kCells + 1 : kAcross + 1;
  Rig<double> rig = sheet_rig<double>(rows, cols, stepping(method, substeps, 3),
                                      {GravityEffect{down}, DampingEffect{}, StrainLimitEffect{}}, material);
  for (int i = 0; i <= kAcross; ++i) {
    rig.particles.inverse_mass.at(along_u ? i : 0, along_u ? 0 : i) = 0;
  }
  for (int step = 0; step < 600; ++step) rig.advance(step * kFrame, kFrame);
  const Vec3 middle =
      get(rig.particles.position, along_u ? kAcross / 2 : kCells, along_u ? kCells : kAcross / 2);
  const double h = kFrame / kSubsteps;
  // XPBD's excess, as in HungSheetStretches: it does not know the springs' stiffness.
  const double excess = method == Method::xpbd ? 9.81 * h * h * (kCells * kCells - kCells - 1) / 2 : 0;
  return (along_u ? middle.x() : -middle.y()) - 1 - excess;
}

TEST_P(StrainLimit, HungSheetStretchesByTheBilinearLaw) {
  // Spring by spring: each carries what hangs below its middle.
  double springs = 0;
  for (int i = 0; i < 16; ++i) springs += 0.125 * elongation(0.1 * 9.81 * 0.125 * (i + 0.5), 20, 0.05);
  // The integral: rho g s1^2 / (2 Y) up to s1 = 1.0194 m, then 0.05 (2 - s1) + rho g (2 - s1)^2 / (40 Y).
  constexpr double s1 = 20 * 0.05 / 0.981, rest = 2 - s1;
  EXPECT_NEAR(springs, 0.981 * s1 * s1 / 40 + 0.05 * rest + 0.981 * rest * rest / 800, 1e-4);
  EXPECT_NEAR(hung_stretch(true, GetParam()), springs, 1e-6);
  EXPECT_NEAR(hung_stretch(false, GetParam()), springs, 1e-6);
}

TEST_P(StrainLimit, ShearedSquareLeansByTheBilinearLaw) {
  // One cell of 1 m, held at its upper edge, its lower edge pushed sideways by F. Its threads hardly stretch,
  // so it leans as a linkage: moved by sin(a), its diagonals are sqrt(2 (1 +- sin a)), and F cos(a) is the
  // derivative of their energy by a. They lock at 0.3 rad; F is chosen so that it leans by 0.4 rad.
  constexpr double kShear = 50, kThreads = 1e5, kLock = 0.3, kLean = 0.4;
  const double rest = std::sqrt(2.0), locked = std::sqrt(2 * (1 + std::sin(kLock)));
  const double longer = std::sqrt(2 * (1 + std::sin(kLean))), shorter = std::sqrt(2 * (1 - std::sin(kLean)));
  // d/da sqrt(2 (1 +- sin a)) = +- cos(a) / length.
  const double force = kShear * ((longer - rest + (kStiffening - 1) * (longer - locked)) / longer -
                                 (shorter - rest) / shorter);
  Material material = strands(kThreads);
  material.shear = kShear;
  material.limit = {1, 1, kLock, kStiffening};
  material.damping = 8;
  Particles<double> cell = flat_sheet<double>(2, 2, {1, 1});
  for (int c : {0, 1}) cell.inverse_mass.at(0, c) = 0;
  const int substeps = GetParam() == Method::symplectic_euler ? 0 : GetParam() == Method::xpbd ? 100 : 1;
  // The lower nodes weigh 1 kg each; with paper each spring has the material's constant.
  Rig<double> rig(std::move(cell), {1, 1}, material, Discretization::paper,
                  {GravityEffect{{force / 2, 0, 0}}, DampingEffect{}, StrainLimitEffect{}},
                  stepping(GetParam(), substeps, 5));
  for (int step = 0; step < 600; ++step) rig.advance(step * kFrame, kFrame);
  const Vec3 side = get(rig.particles.position, 1, 0) - get(rig.particles.position, 0, 0);
  // The threads give by F / 1e5 N/m, some 5e-4 m; XPBD's springs by F h^2 / m more, 2e-6 m.
  EXPECT_NEAR(std::atan2(side.x(), -side.y()), kLean, 1e-3);
  EXPECT_NEAR(force, 54.23, 0.01);  // without the limit 21.57 N would do
}

}  // namespace
}  // namespace weft::test
