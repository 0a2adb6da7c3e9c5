#pragma once
#include <string_view>
#include <vector>

#include "cloth/world/description.h"

/// Numbers of effects and materials that may be changed while a scene runs, by the names that scene files
/// have for them. Each throws weft::Error where there is none of that name, or the values are not in its
/// range; then nothing is changed.
namespace weft::library {

/// There is such an effect.
void check_effect(const std::vector<EffectDescription>& effects, std::string_view effect);
/// Of all effects of that name.
void set_effect_parameter(std::vector<EffectDescription>& effects, std::string_view effect,
                          std::string_view parameter, const std::vector<double>& values);
/// In a scene of these effects.
void set_material_parameter(Material& material, const std::vector<EffectDescription>& effects,
                            std::string_view parameter, const std::vector<double>& values);

}  // namespace weft::library
