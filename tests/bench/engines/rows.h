#pragma once
#include <string>
#include <vector>

#include "engines/competitors.h"

namespace weft::bench {

/// What one competitor did in a scene.
struct Row {
  EngineScene scene;
  Competitor competitor;
  Measurement measured;
};

/// All rows of a run.
class Rows {
 public:
  void add(Row row) { rows_.push_back(std::move(row)); }

  /// What it did, or nullptr if it was not in the run.
  const Measurement* find(const EngineScene& scene, const std::string& engine, const std::string& setting,
                          double structural) const;
  /// Weft's bdf2 as it comes, on the stiff sheet.
  const Measurement* bdf2(const EngineScene& scene) const;
  /// Weft's fastest row in which the sheet stretches at most so far and, in the last second, moves at least
  /// so fast (m/s); or nullptr.
  const Row* fastest_weft(const EngineScene& scene, double max_strain, double rms_speed) const;

 private:
  std::vector<Row> rows_;
};

}  // namespace weft::bench
