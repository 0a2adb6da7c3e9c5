#include "library/parameters.h"

#include <algorithm>
#include <string>

#include "cloth/forces/effect.h"
#include "library/checks.h"
#include "scene/effect_parameters.h"
#include "scene/material_parameters.h"

namespace weft::library {
namespace {

std::vector<double> checked(const scene::ParameterKind& parameter, const std::vector<double>& values) {
  const bool one = values.size() == 1 && parameter.takes_one();
  if (!one && values.size() != parameter.count) {
    throw Error(std::string(parameter.name) + " is of " + std::to_string(values.size()) +
                " numbers; must be of " + std::to_string(parameter.count));
  }
  for (const double value : values) within(value, parameter.name, parameter.range);
  std::vector<double> all = values;
  all.resize(parameter.count, values[0]);
  return all;
}

/// The one of `known` that has the name.
template <class Known>
const typename Known::value_type& named(const Known& known, std::string_view name) {
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& each) { return each.name == name; });
  if (found != known.end()) return *found;
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& each : known) names.emplace_back(each.name);
  refuse_name("parameter", name, names);
}

}  // namespace

void check_effect(const std::vector<EffectDescription>& effects, std::string_view effect) {
  std::vector<std::string> names;
  for (const EffectDescription& each : effects) {
    if (name_of(each) == effect) return;
    names.emplace_back(name_of(each));
  }
  refuse_name("effect", effect, names);
}

void set_effect_parameter(std::vector<EffectDescription>& effects, std::string_view effect,
                          std::string_view parameter, const std::vector<double>& values) {
  check_effect(effects, effect);
  std::vector<EffectDescription> changed = effects;
  for (EffectDescription& each : changed) {
    if (name_of(each) != effect) continue;
    const scene::EffectParameter& found = named(scene::parameters_of(each), parameter);
    found.write(each, checked(found, values));
  }
  effects = std::move(changed);
}

void set_material_parameter(Material& material, const std::vector<EffectDescription>& effects,
                            std::string_view parameter, const std::vector<double>& values) {
  const std::vector<scene::MaterialParameter> known = scene::material_parameters(effects);
  const scene::MaterialParameter& found = named(known, parameter);
  found.write(material, checked(found, values));
}

}  // namespace weft::library
