#pragma once
#include <vector>

namespace weft {

/// Which level a viewer's distance deserves: Eq. 7, generalised to any ascending list of thresholds.
struct LevelPolicy {
  /// Distances at which the level changes, m, ascending; Table 1: l_close = 1, l_far = 10.
  std::vector<double> thresholds{1.0, 10.0};
  /// Level within each band, one more than thresholds, descending: 64x64, 32x32, 16x16 cells.
  std::vector<int> levels{6, 5, 4};
  /// Share of a threshold by which the distance must pass it before the level changes back or forth; 0
  /// follows Eq. 7 to the letter (the paper's presets), 0.1 stops a swaying camera from flapping.
  double hysteresis = 0.0;

  /// Eq. 7: the level at `distance` (m, >= 0) for a viewer that had none. A threshold itself still belongs to
  /// the nearer band (at exactly 10 m the paper's middle level).
  int level_at(double distance) const;

  /// The level at `distance` for a viewer now at `current`: leaving the current band takes threshold * (1 +
  /// hysteresis) outwards, threshold * (1 - hysteresis) inwards.
  int level_at(double distance, int current) const;
};

}  // namespace weft
