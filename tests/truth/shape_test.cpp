// Shapes at rest: a hung sheet's stretch (T9) and a catenary (T10).
#include "methods.h"

namespace weft::test {
namespace {

using Shape = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Shape, ::testing::ValuesIn(kMethods), name_of_case);

// T9: a sheet of 2 m hung by its top edge stretches by rho g L^2 / (2 Y), on any grid. XPBD with n substeps
// of h adds g h^2 (N^2 - N - 1) / 2: each spring is projected once (Macklin, Storey, Lu, Terdiman, Chentanez,
// Jeschke and Mueller 2019 show that the error falls with h^2; the sum over the rows is ours).
TEST_P(Shape, HungSheetStretches) {
  constexpr int kCells = 16, kSubsteps = 40;
  constexpr double kStiffness = 5000, kDensity = 0.1;
  Material material = strands(kStiffness, kDensity);
  material.damping = 2;  // 20 /s: at rest within a second or two
  const int substeps = GetParam() == Method::xpbd               ? kSubsteps
                       : GetParam() == Method::symplectic_euler ? 0
                                                                : 1;
  Rig<double> rig = sheet_rig<double>(kCells + 1, 5, stepping(GetParam(), substeps),
                                      {GravityEffect{}, DampingEffect{}}, material);
  for (int c = 0; c < 5; ++c) rig.particles.inverse_mass.at(0, c) = 0;
  for (int step = 0; step < 600; ++step) rig.advance(step * kFrame, kFrame);
  const double stretch = -1 - get(rig.particles.position, kCells, 2).y();
  const double h = kFrame / kSubsteps;
  const double excess = GetParam() == Method::xpbd ? 9.81 * h * h * (kCells * kCells - kCells - 1) / 2 : 0;
  EXPECT_NEAR(stretch, kDensity * 9.81 * 4 / (2 * kStiffness) + excess, 1e-7);
}

// T10: a strip of 2 m between supports 1.2 m apart hangs as y = a cosh(x/a), 2 a sinh(D/(2a)) = S.
TEST_P(Shape, Catenary) {
  constexpr double kLength = 2, kSpan = 1.2, a = 0.326337;
  EXPECT_NEAR(2 * a * std::sinh(kSpan / (2 * a)), kLength, 1e-5);
  const double sag = a * (std::cosh(kSpan / (2 * a)) - 1);
  EXPECT_NEAR(sag, 0.725564, 1e-5);

  constexpr int kCells = 64, kRows = 3;
  constexpr double kWidth = 0.0625;
  Particles<double> sheet = flat_sheet<double>(kRows, kCells + 1, {kLength, kWidth});
  share_mass(sheet, 0.1 * kLength * kWidth, Discretization::continuum);
  // It starts as two straight halves that meet below the middle.
  const double depth = std::sqrt(kLength * kLength - kSpan * kSpan) / 2;
  each_node(sheet.grid(), [&](int r, int c) {
    const double t = 2.0 * c / kCells - 1;  // -1 .. 1
    const double z = (double(r) / (kRows - 1) - 0.5) * kWidth;
    set(sheet.position, r, c, {t * kSpan / 2, (std::abs(t) - 1) * depth, z});
    if (c == 0 || c == kCells) sheet.inverse_mass.at(r, c) = 0;
  });
  Material material = strands(1e4);
  material.damping = 0.5;  // 5 /s
  const int substeps = GetParam() == Method::xpbd ? 80 : GetParam() == Method::symplectic_euler ? 0 : 1;
  Rig<double> rig(std::move(sheet), {kLength, kWidth}, material, Discretization::continuum,
                  {GravityEffect{}, DampingEffect{}}, stepping(GetParam(), substeps));
  for (int step = 0; step < 600; ++step) rig.advance(step * kFrame, kFrame);
  // 64 straight links instead of a curve: of second order, (S/64)^2 / a / 8 = 4e-4 m at most. XPBD's strip is
  // longer, as if hung straight from each end: by g h^2 n^2 / 2 for n = 32 links, h = 1/4800 s, 2e-4 m.
  const Vec3 middle = get(rig.particles.position, 1, kCells / 2);
  EXPECT_NEAR(-middle.y(), sag, GetParam() == Method::xpbd ? 6e-4 : 4e-4);
  // The first link's slope is the curve's where its middle is, at arc length S/2 - S/128 from the lowest
  // point.
  const Vec3 link = get(rig.particles.position, 1, 1) - get(rig.particles.position, 1, 0);
  const double arc = kLength / 2 - kLength / (2 * kCells);
  EXPECT_NEAR(std::atan2(-link.y(), link.x()), std::atan(arc / a), 5e-3);
  EXPECT_NEAR(std::atan(kLength / 2 / a) * 180 / std::numbers::pi, 71.9266, 1e-3);
}

}  // namespace
}  // namespace weft::test
