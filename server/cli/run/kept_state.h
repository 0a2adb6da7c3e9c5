#pragma once
/// A run's last state in a file, from which another run goes on. The file is a recording without a step
/// (record/chunks.h): it names its scene and the version of Weft, and has checksums and a hash of the state.
#include <string>

#include "cli/writers/output_file.h"
#include "cloth/world/simulation.h"
#include "scene/scene.h"

namespace weft::cli {

/// Writes the state as it is now, and closes the file. Throws as OutputFile.
void keep_state(OutputFile& file, const scene::Scene& scene, const Simulation<float>& simulation);

/// Takes `simulation`, which is of `scene`, to where `path` ends: what keep_state() wrote, or any recording.
/// Throws std::runtime_error or std::invalid_argument, naming the file and what is wrong, if it cannot be
/// read, is damaged, or is of another scene or version.
void go_on_from(const std::string& path, const scene::Scene& scene, Simulation<float>& simulation);

}  // namespace weft::cli
