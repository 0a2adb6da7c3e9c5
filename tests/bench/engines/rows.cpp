#include "engines/rows.h"

#include <algorithm>

namespace weft::bench {

const Measurement* Rows::find(const EngineScene& scene, const std::string& engine, const std::string& setting,
                              double structural) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) {
    return row.scene == scene && row.competitor.engine == engine && row.competitor.setting == setting &&
           row.competitor.structural == structural;
  });
  return found == rows_.end() ? nullptr : &found->measured;
}

const Measurement* Rows::bdf2(const EngineScene& scene) const {
  return find(scene, "Weft bdf2", "default", kStiff);
}

const Row* Rows::fastest_weft(const EngineScene& scene, double max_strain, double rms_speed) const {
  const Row* fastest = nullptr;
  for (const Row& row : rows_) {
    const Measurement& m = row.measured;
    if (row.scene != scene || !row.competitor.engine.starts_with("Weft") || !m.sound()) continue;
    if (m.max_strain > max_strain || m.rms_speed < rms_speed) continue;
    if (fastest == nullptr || m.median_ms < fastest->measured.median_ms) fastest = &row;
  }
  return fastest;
}

}  // namespace weft::bench
