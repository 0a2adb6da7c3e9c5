#pragma once
#include <nlohmann/json.hpp>

#include "cloth/world/description.h"

namespace weft::stability {

/// The scene file that reads as this description (server/scene).
nlohmann::json scene_json(const SimulationDescription& scene);

}  // namespace weft::stability
