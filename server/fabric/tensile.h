#pragma once
#include "cloth/sheet/material.h"

namespace weft::fabric {

/// KES-FB1, tension (Kawabata, The Standardization and Analysis of Hand Evaluation, 1980): cloth 20 cm wide
/// and 5 cm long between two jaws, pulled up to 490 N/m (500 gf/cm).
struct Tensile {
  double extension = 0;  ///< EMT: elongation at the largest load, a share of the length
  double work = 0;       ///< WT: under the curve, J/m2
  double linearity = 0;  ///< LT: WT over the triangle's
};

inline constexpr double kLargestLoad = 500 * 0.00980665 / 0.01;  ///< N/m

/// Along u; with `limited` threads are pulled straight at the material's limit. Throws NoRest, also for cloth
/// that is at three times its length still below the largest load.
Tensile tensile(const Material& material, bool limited);

/// Y of threads that show this extension: the jaws keep the cloth as wide as it is, so that its diagonals
/// stretch, too, and add the shear stiffness, N/m.
double stiffness_of(double extension, double shear);

}  // namespace weft::fabric
