#pragma once
/// Per-frame figures as CSV.
#include <string>

#include "cli/writers/output_file.h"
#include "cloth/world/simulation.h"

namespace weft::cli {

/// One line a frame and cloth: frame, time (s), level, substeps, milliseconds (wall time of the whole step),
/// energies (J), strains, nodes in contact, what the step's numerics took of the energy and what was given
/// back (J, AdvanceReport); a last column with the cloth's name if the scene has several. All
/// but milliseconds are the same in every run.
class StatsWriter {
 public:
  /// Throws std::runtime_error if `path` cannot be written.
  StatsWriter(const std::string& path, bool several_cloths);
  /// `frame` counts from 0, the start.
  void write(int frame, const Simulation<float>& simulation);
  void finish() { file_.close(); }

 private:
  OutputFile file_;
  bool several_cloths_;
};

}  // namespace weft::cli
