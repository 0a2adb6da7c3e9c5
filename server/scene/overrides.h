#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "scene/scene.h"

namespace weft::scene {

/// Applies one POINTER=VALUE to a scene's document. VALUE is JSON, or else a string. Objects on the way are
/// made; null takes the member away; "-" or the array's size as the last part appends.
std::optional<Problem> apply_override(std::string_view text, nlohmann::json& document);

}  // namespace weft::scene
