#pragma once
/// How a case must end: rest shapes that are known without a gentle run.
#include "case.h"

namespace weft::stability {

/// Hung by its top edge a sheet comes to rest flat, longer than it was made by rho g L^2 / (2 Y) (T9 of the
/// truths) and with XPBD by g h^2 (N^2 - N - 1) / 2 more (shape_test.cpp): every node within `share` of the
/// size of there, however it got there.
Ending hangs_flat(double share);

/// Held by its left edge, a ribbon hangs straight down: its free end is its length below, within `share`.
Ending ribbon_hangs_down(double share);

}  // namespace weft::stability
