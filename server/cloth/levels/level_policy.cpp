#include "cloth/levels/level_policy.h"

#include <algorithm>

namespace weft {

int LevelPolicy::level_at(double distance) const {
  std::size_t band = 0;
  while (band < thresholds.size() && !(distance <= thresholds[band])) ++band;
  return levels[band];
}

int LevelPolicy::level_at(double distance, int current) const {
  const auto found = std::find(levels.begin(), levels.end(), current);
  if (found == levels.end()) return level_at(distance);
  auto band = static_cast<std::size_t>(found - levels.begin());
  while (band < thresholds.size() && distance > thresholds[band] * (1 + hysteresis)) ++band;
  while (band > 0 && distance <= thresholds[band - 1] * (1 - hysteresis)) --band;
  return levels[band];
}

}  // namespace weft
