#include "cloth/sheet/material.h"

#include <algorithm>
#include <array>

namespace weft {
namespace {

// Density, warp, weft and shear stiffness and thickness are those of the table of measured woven fabrics in
// the source of Codim-IPC (Li, Kaufman and Jiang, SIGGRAPH 2021, arXiv 2012.04457;
// Python/Drivers/FEMDiscreteShellBase.py, cloth_density, cloth_thickness, cloth_weftWarpMult), whose fabric
// energy has the form of Clyde, Teran and Tamstorf, "Modeling and data-driven parameter estimation for woven
// fabrics", SCA 2017: per volume
//   a11/2 E11^2 + a12 E11 E22 + a22/2 E22^2 + a33 E12^2.
// From it, times the thickness t:
//   structural = (a11 + a22) t / 2, the mean of warp and weft: one constant serves both directions here;
//   shear = a33 t / 2, since the engineering shear strain is 2 E12.
// a12 has no counterpart in springs. The densities are read as g/m2 (103.6 for a shirt's cotton, 400 for
// denim): taken as kg/m3, as that source does, the cotton would weigh 19 g/m2.
//
// Denim's rigidity is that of an 11 oz denim (324 g/m2) as measured by Wang, O'Brien and Ramamoorthi,
// "Data-driven elastic models for cloth: modeling and measurement", SIGGRAPH 2011, at small curvature: 64, 73
// and 97 uN m at 0, 45 and 90 degrees. The twist follows from the one on the bias (material.h).
//
// Chosen, not measured: the other rigidities, of the order usual for such cloths, alike in all directions;
// bending, a thousandth of structural, which leaves the in-plane stiffness as measured
// within 0.2 % and lets the sheet fold freely (second-neighbour springs have no bending rigidity of their
// own); damping, a light drag that slows the silk within a second and the wool within five.
//
// Polyester and stretch_wool (95 % wool, 5 % lycra) are the plain woven fabrics whose moduli Penava, Simic
// Penava and Knezic measured, "Determination of the elastic constants of plain woven fabrics by a tensile
// test in various directions", Fibres and Textiles in Eastern Europe 22(2), 2014, as the same source
// tabulates them (cloth_Ebase_iso and the multiples of it along the threads; cloth_SL_iso, where they
// stiffen; which of the two is the warp it does not say: here the first). With E1 and E2 along the threads
// and Eb on the bias
//   1 / G = 4 / Eb - (1 - 2 nu) / E1 - 1 / E2
// (Lekhnitskii, Anisotropic Plates, 1968). Their rigidities are not of these cloths: the medians along warp,
// weft and bias of those fabrics, of the 618 that Feng, Huang, Xu and Wang measured by cantilever
// ("Learning-based bending stiffness parameter estimation by a drape tester", SIGGRAPH Asia 2022), that weigh
// as much within 10 %.
constexpr double kDrag = 0.1;  // N s/m3

struct Measured {
  double grams_per_square_metre;
  double a11, a22, a33;  // MPa
  double thickness;      // mm
  Rigidity rigidity;     // N m
};

constexpr Rigidity even(double rigidity) { return {rigidity, rigidity, rigidity}; }
/// From those along u, v and the bias.
constexpr Rigidity woven(double u, double v, double bias) { return {u, v, 2 * bias - (u + v) / 2}; }

/// MPa times mm are 1e3 N/m.
constexpr Material from(const Measured& m) {
  const double structural = (m.a11 + m.a22) / 2 * m.thickness * 1e3;
  return {m.grams_per_square_metre * 1e-3,
          structural,
          m.a33 / 2 * m.thickness * 1e3,
          structural / 1000,
          kDrag,
          m.rigidity};
}

struct MeasuredPlain {
  double grams_per_square_metre;
  double e1, e2, bias;  // MPa
  double poisson;
  double thickness;   // mm
  double stiffens;    // elongation
  Rigidity rigidity;  // N m
};

constexpr Material from(const MeasuredPlain& m) {
  const double to_sheet = m.thickness * 1e3;
  const double shear = to_sheet / (4 / m.bias - (1 - 2 * m.poisson) / m.e1 - 1 / m.e2);
  const Stiffness structural(m.e1 * to_sheet, m.e2 * to_sheet);
  return {m.grams_per_square_metre * 1e-3,
          structural,
          shear,
          (structural.warp + structural.weft) / 2000,
          kDrag,
          m.rigidity,
          {m.stiffens, m.stiffens}};
}

constexpr std::string_view kSource =
    "density, stretch and shear: measured woven fabrics as tabulated in the source of Codim-IPC (Li, "
    "Kaufman, Jiang, "
    "SIGGRAPH 2021, arXiv 2012.04457), mean of warp and weft; bending, rigidity and damping: chosen";
constexpr std::string_view kDenimSource =
    "as the others; rigidity: an 11 oz denim (Wang, O'Brien, Ramamoorthi, SIGGRAPH 2011)";

constexpr std::string_view kPlainSource =
    "density, stretch and shear: Penava, Simic Penava, Knezic, Fibres and Textiles in Eastern Europe 22(2), "
    "2014, as tabulated in the source of Codim-IPC; rigidity: median of fabrics of that weight in Feng, "
    "Huang, "
    "Xu, Wang, SIGGRAPH Asia 2022; damping: chosen";

constexpr std::array<Fabric, 7> kFabrics{{
    {"silk", from(Measured{83, 4.3, 9.942, 0.57, 0.18, even(5e-6)}), kSource},
    {"cotton", from(Measured{103.6, 15.557, 25.004, 1.076, 0.18, even(1e-5)}), kSource},
    {"canvas", from(Measured{294, 5.366, 19.804, 2.009, 0.53, even(1e-4)}), kSource},
    {"denim", from(Measured{400, 4.793, 9.029, 2.448, 0.66, woven(6.4e-5, 9.7e-5, 7.3e-5)}), kDenimSource},
    {"wool", from(Measured{480.6, 2.29, 2.219, 0.371, 1.28, even(5e-5)}), kSource},
    {"polyester",
     from(MeasuredPlain{164.6, 5.152, 11.674, 0.478, 0.381, 0.252, 0.0646, woven(1.45e-5, 7.7e-6, 9.4e-6)}),
     kPlainSource},
    {"stretch_wool",
     from(MeasuredPlain{178.2, 0.25, 0.851, 0.076, 0.071, 0.328, 0.134, woven(1.69e-5, 7.8e-6, 1.43e-5)}),
     kPlainSource},
}};

}  // namespace

std::span<const Fabric> fabrics() { return kFabrics; }

const Fabric* find_fabric(std::string_view name) {
  const auto found = std::find_if(kFabrics.begin(), kFabrics.end(),
                                  [&](const Fabric& fabric) { return fabric.name == name; });
  return found == kFabrics.end() ? nullptr : &*found;
}

}  // namespace weft
