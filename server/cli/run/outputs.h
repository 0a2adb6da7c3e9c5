#pragma once
#include <memory>
#include <string>
#include <vector>

#include "cli/mesh_writer.h"
#include "cli/stats_writer.h"
#include "cloth/world/simulation.h"

namespace weft::cli {

/// All files that a run writes frame by frame: meshes and figures.
class RunOutputs {
 public:
  /// `meshes`: paths of --out; `stats`: empty for none; `frames`: that will be written. Throws
  /// std::runtime_error if one cannot be written, or cannot hold so many.
  RunOutputs(const std::vector<std::string>& meshes, const std::string& stats, int frames,
             const SimulationDescription& description);

  void write(int frame, const Simulation<float>& simulation);
  void finish();
  /// As they are named to whoever asks.
  const std::vector<std::string>& files() const { return files_; }

 private:
  std::vector<std::vector<std::unique_ptr<MeshWriter>>> writers_;
  std::vector<std::string> files_;
  std::unique_ptr<StatsWriter> stats_;
};

}  // namespace weft::cli
