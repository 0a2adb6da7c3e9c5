#pragma once

namespace weft::bench {

struct ManyCloths {
  double median_ms = 0, least_ms = 0;  ///< CPU time of a frame of all cloths
};

/// A scene of `count` cloths, each that of the preset "flag" at this level in its wind, bdf2 with its default
/// settings, 60 frames a second; measured over the third and fourth second.
ManyCloths measure_flags(int count, int level);

}  // namespace weft::bench
