#pragma once
#include "cloth/world/description.h"

namespace weft::bench {

/// A scene of `count` cloths, each that of the preset "flag" at this level in its wind, bdf2 with its default
/// settings, 60 frames a second.
SimulationDescription flags(int count, int level);

struct ManyCloths {
  double median_ms = 0, least_ms = 0;  ///< CPU time of a frame of all cloths
};

/// Those flags, measured over the third and fourth second.
ManyCloths measure_flags(int count, int level);

}  // namespace weft::bench
