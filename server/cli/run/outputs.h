#pragma once
#include <memory>
#include <string>
#include <vector>

#include "cli/stats_writer.h"
#include "cli/writers/scene_writer.h"
#include "cloth/world/simulation.h"
#include "scene/scene.h"

namespace weft::cli {

/// All files that a run writes frame by frame: meshes and figures.
class RunOutputs {
 public:
  /// `meshes`: paths of --out; `stats`: empty for none; `frames`: that will be written. Throws
  /// std::runtime_error if one cannot be written.
  RunOutputs(const std::vector<std::string>& meshes, const std::string& stats, int frames,
             const scene::Scene& scene, const Simulation<float>& simulation);

  void write(int frame, const Simulation<float>& simulation);
  void finish();
  std::vector<std::string> files() const;

 private:
  std::vector<std::unique_ptr<SceneWriter>> writers_;
  std::string stats_path_;
  std::unique_ptr<StatsWriter> stats_;
};

}  // namespace weft::cli
