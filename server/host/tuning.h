#pragma once
/// effect.tune and cloth.tune: numbers of a scene's effects and materials, told to viewers and changed by
/// them.
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cloth/world/description.h"
#include "protocol/message.h"

namespace weft::host {

/// Gives the effects of that name the command's parameters; or says what is wrong with them, and then nothing
/// is changed. One of the effects has the name.
std::optional<protocol::Error> tune(const protocol::EffectTune& command,
                                    std::vector<EffectDescription>& effects);

/// The same of a cloth's material in a scene of these effects.
std::optional<protocol::Error> tune(const protocol::ClothTune& command,
                                    const std::vector<EffectDescription>& effects, Material& material);

/// {"drag": 1.2, ...}: a number, or an array where it has several; null if the effect has none.
nlohmann::json parameters_json(const EffectDescription& effect);
/// `parameters` of `scene` and `reset`: the above by the names of the effects that have any.
nlohmann::json parameters_json(const std::vector<EffectDescription>& effects);
/// `tunable` of `scene`: {"gravity": {"acceleration": {"range": [...], "unit": "m/s2"}}, ...}.
nlohmann::json tunable_json(const std::vector<EffectDescription>& effects);
/// `material` of a cloth of `scene`: what is felt of it in a scene of these effects.
nlohmann::json material_json(const Material& material, const std::vector<EffectDescription>& effects);
/// `materials` of `reset`: the same of each cloth.
nlohmann::json materials_json(const std::vector<Material>& materials,
                              const std::vector<EffectDescription>& effects);
/// `material_tunable` of `scene`: as the effects', and by which effect a number is felt.
nlohmann::json material_tunable_json(const std::vector<EffectDescription>& effects);

}  // namespace weft::host
