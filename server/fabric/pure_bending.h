#pragma once
#include "cloth/sheet/material.h"

namespace weft::fabric {

/// KES-FB2 (Kawabata, The Standardization and Analysis of Hand Evaluation, 1980): 1 cm of cloth between two
/// clamps that turn, so that it is bent to an even curvature. Returns the slope of the moment between 0.5 and
/// 1.5 /cm, N m, along u. Throws NoRest.
double pure_bending(const Material& material);

}  // namespace weft::fabric
