// A sheet that pressure bulges out, against its shape by hand.
#include "methods.h"

namespace weft::test {
namespace {

using Inflation = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Inflation, ::testing::ValuesIn(kMethods), name_of_case);

/// A strip of `width` and stiffness Y between two held edges, under the pressure p: n equal chords of a
/// circle of radius R. With the angle a between two of them a node is pushed by p times the chord's length
/// times cos(a/2), against 2 T sin(a/2): T = p R cos(a/2), the vessel formula T = p R for n to infinity.
struct Arc {
  double radius, angle, tension;

  Arc(double width, int n, double stiffness, double pressure) {
    // A chord is 2 R sin(a/2) long, and 1 + T/Y times width/n; all of them span 2 R sin(n a/2) = width.
    double low = 0, high = std::numbers::pi / n;
    for (int i = 0; i < 200; ++i) {
      angle = (low + high) / 2;
      radius = width / (2 * std::sin(n * angle / 2));
      tension = pressure * radius * std::cos(angle / 2);
      const double chord = 2 * radius * std::sin(angle / 2);
      (chord < width / n * (1 + tension / stiffness) ? low : high) = angle;
    }
  }
  double height(int n) const { return radius * (1 - std::cos(n * angle / 2)); }
};

TEST_P(Inflation, BulgesAStripAsTheVesselFormulaSays) {
  constexpr int kCells = 16, kSubsteps = 100;
  constexpr double kWidth = 2, kStiffness = 5000, kPressure = 500, kDensity = 0.1, kFrames = 1200;
  Material material = strands(kStiffness, kDensity);
  material.damping = 2;  // 20 /s
  const int substeps = GetParam() == Method::symplectic_euler ? 0
                       : GetParam() == Method::xpbd           ? kSubsteps
                                                              : 1;
  Rig<double> rig = sheet_rig<double>(5, kCells + 1, stepping(GetParam(), substeps, 4),
                                      {DampingEffect{}, InflationEffect{kPressure}}, material);
  for (int r = 0; r < 5; ++r) {
    for (int c : {0, kCells}) rig.particles.inverse_mass.at(r, c) = 0;
  }
  for (int step = 0; step < kFrames; ++step) rig.advance(step * kFrame, kFrame);
  // Some 0.46 m for T = 662 N/m, R = 1.33 m: a stretch of 13 %.
  const Arc arc(kWidth, kCells, kStiffness, kPressure);
  EXPECT_NEAR(arc.tension, kPressure * arc.radius, 0.01 * arc.tension);
  double height = arc.height(kCells), tolerance = 1e-6;
  if (GetParam() == Method::xpbd) {
    // Its springs are longer by F h^2 / m (HungSheetStretches), as if 1/Y were larger by h^2 / (rho hx^2);
    // but for the last ones, one in n.
    const double h = kFrame / kSubsteps, hx = kWidth / kCells;
    const double softer = 1 / (1 / kStiffness + h * h / (kDensity * hx * hx));
    const double excess = Arc(kWidth, kCells, softer, kPressure).height(kCells) - height;
    height += excess;
    tolerance = 1.1 * excess / kCells;
    EXPECT_LT(tolerance, 2e-3);
  }
  for (int r = 0; r < 5; ++r) {
    EXPECT_NEAR(get(rig.particles.position, r, kCells / 2).z(), height, tolerance) << r;
  }
}

}  // namespace
}  // namespace weft::test
