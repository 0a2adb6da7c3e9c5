#include "cli/run/kept_state.h"

#include <stdexcept>

#include "cloth/world/state.h"
#include "record/last_state.h"
#include "record/recorder.h"

namespace weft::cli {

void keep_state(OutputFile& file, const scene::Scene& scene, const Simulation<float>& simulation) {
  record::Recorder recorder(scene, {{"weft", WEFT_VERSION}},
                            [&file](const std::string& bytes) { file.write(bytes); });
  recorder.add_state(simulation);
  recorder.add_hash(simulation);
  recorder.flush();
  file.close();
}

void go_on_from(const std::string& path, const scene::Scene& scene, Simulation<float>& simulation) {
  const record::Recording recording = record::Recording::of_file(path);
  try {
    if (!recording.damage().empty()) throw std::invalid_argument(recording.damage());
    load_state(simulation, record::last_state(recording, WEFT_VERSION, scene).state);
  } catch (const std::exception& fault) {
    throw std::invalid_argument(path + ": cannot go on from it: " + fault.what());
  }
}

}  // namespace weft::cli
