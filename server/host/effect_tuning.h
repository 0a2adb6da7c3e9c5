#pragma once
/// effect.tune: parameters of a scene's effects, told to viewers and changed by them.
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cloth/description.h"
#include "protocol/message.h"

namespace weft::host {

/// Gives the effects of that name the command's parameters; or says what is wrong with them, and then nothing
/// is changed. One of the effects has the name.
std::optional<protocol::Error> tune(const protocol::EffectTune& command,
                                    std::vector<EffectDescription>& effects);

/// {"drag": 1.2, ...}: a number, or an array where it has several; null if the effect has none.
nlohmann::json parameters_json(const EffectDescription& effect);
/// `parameters` of `scene` and `reset`: the above by the names of the effects that have any.
nlohmann::json parameters_json(const std::vector<EffectDescription>& effects);
/// `tunable` of `scene`: {"gravity": {"acceleration": {"range": [...], "unit": "m/s2"}}, ...}.
nlohmann::json tunable_json(const std::vector<EffectDescription>& effects);

}  // namespace weft::host
