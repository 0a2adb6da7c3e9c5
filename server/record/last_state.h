#pragma once
#include <string>

#include "record/recording.h"

namespace weft::record {

/// Where a recording ends, to go on from.
struct LastState {
  std::string state;    ///< of the simulation (cloth/world/state.h)
  std::string service;  ///< of what was served beside it; empty if that was not recorded
};

/// Makes all steps of the recording again and checks them by its hashes; what is damaged is left out. Throws
/// std::invalid_argument, saying why, if nothing of `version` of Weft and of `scene` can go on from it.
LastState last_state(const Recording& recording, const std::string& version, const scene::Scene& scene);

}  // namespace weft::record
