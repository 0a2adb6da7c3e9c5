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

constexpr std::string_view kSource =
    "density, stretch and shear: measured woven fabrics as tabulated in the source of Codim-IPC (Li, "
    "Kaufman, Jiang, "
    "SIGGRAPH 2021, arXiv 2012.04457), mean of warp and weft; bending, rigidity and damping: chosen";
constexpr std::string_view kDenimSource =
    "as the others; rigidity: an 11 oz denim (Wang, O'Brien, Ramamoorthi, SIGGRAPH 2011)";

constexpr std::array<Fabric, 5> kFabrics{{
    {"silk", from({83, 4.3, 9.942, 0.57, 0.18, even(5e-6)}), kSource},
    {"cotton", from({103.6, 15.557, 25.004, 1.076, 0.18, even(1e-5)}), kSource},
    {"canvas", from({294, 5.366, 19.804, 2.009, 0.53, even(1e-4)}), kSource},
    {"denim", from({400, 4.793, 9.029, 2.448, 0.66, woven(6.4e-5, 9.7e-5, 7.3e-5)}), kDenimSource},
    {"wool", from({480.6, 2.29, 2.219, 0.371, 1.28, even(5e-5)}), kSource},
}};

}  // namespace

std::span<const Fabric> fabrics() { return kFabrics; }

const Fabric* find_fabric(std::string_view name) {
  const auto found = std::find_if(kFabrics.begin(), kFabrics.end(),
                                  [&](const Fabric& fabric) { return fabric.name == name; });
  return found == kFabrics.end() ? nullptr : &*found;
}

}  // namespace weft
