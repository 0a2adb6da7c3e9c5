#pragma once
#include <numbers>

#include "cloth/sheet/material.h"

namespace weft::fabric {

/// KES-FB1, shear (Kawabata 1980): cloth between jaws 5 cm apart is sheared to 8 degrees under a tension of
/// 9.8 N/m (10 gf/cm), which draws along the inclined threads: its part is taken off.
struct Shear {
  double stiffness = 0;     ///< G, slope between 0.5 and 2.5 degrees, N/m per radian
  double at_8_degrees = 0;  ///< force, N/m
};

/// N/m per radian in one gf/cm per degree, the instrument's unit.
inline constexpr double kGramForcePerDegree = 0.00980665 / 0.01 * 180 / std::numbers::pi;

/// The threads along u are those between the jaws. Throws NoRest.
Shear shear(const Material& material, bool limited);

}  // namespace weft::fabric
