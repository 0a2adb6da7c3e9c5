#pragma once
/// The numbers of each effect that scene files give and that may be changed while a scene runs, with their
/// ranges: the one table for both.
#include "cloth/world/description.h"
#include "scene/parameter.h"

namespace weft::scene {

using EffectParameter = Parameter<EffectDescription>;

/// Those of the effect's type, in the order in which they are read and listed; none if it has no numbers. An
/// inflation with a volume is of gas and has others than one without.
const std::vector<EffectParameter>& parameters_of(const EffectDescription& effect);

}  // namespace weft::scene
