#include "record/last_state.h"

#include <stdexcept>

#include "cloth/world/state.h"
#include "record/replay.h"

namespace weft::record {

LastState last_state(const Recording& recording, const std::string& version, const scene::Scene& scene) {
  const auto& head = recording.head();
  const std::string by = head.value("weft", "?"), name = head.value("name", "?");
  if (by != version)
    throw std::invalid_argument("it is of another version of Weft, " + by + "; this is " + version);
  if (name != scene.name)
    throw std::invalid_argument("it is of another scene, " + name + "; this is " + scene.name);
  if (head.value("document", "") != scene.document)
    throw std::invalid_argument("it is of another scene by that name, or of other values (--set)");
  Replay replay(recording);
  while (replay.step()) {
  }
  if (replay.hashes() == 0) {
    std::string what = "it has no whole state";
    if (!recording.damage().empty()) what.append(": ").append(recording.damage());
    throw std::invalid_argument(what);
  }
  if (const auto& other = replay.divergence())
    throw std::invalid_argument("after " + std::to_string(other->step) +
                                " steps it does not lead to the state that it tells");
  return {save_state(replay.simulation()), std::string(replay.service())};
}

}  // namespace weft::record
