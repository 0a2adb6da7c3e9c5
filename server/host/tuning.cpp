#include "host/tuning.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cloth/forces/effect.h"
#include "protocol/member.h"
#include "scene/effect_parameters.h"
#include "scene/material_parameters.h"

namespace weft::host {
namespace {

using nlohmann::json;
using protocol::Bounds;
using protocol::Numbers;
using protocol::pointer_to;
using scene::EffectParameter;
using scene::MaterialParameter;
using scene::ParameterKind;

/// As a client writes it: whole numbers without a fraction.
json number_json(double number) {
  constexpr double kExact = 1e15;
  if (number == std::floor(number) && std::abs(number) < kExact) return static_cast<std::int64_t>(number);
  return number;
}

json numbers_json(const Numbers& numbers) {
  if (numbers.size() == 1) return number_json(numbers[0]);
  json array = json::array();
  for (const double number : numbers) array.push_back(number_json(number));
  return array;
}

std::string kind_of(const ParameterKind& parameter, const Bounds& bounds) {
  std::string one = protocol::kind_of(double{}, bounds);
  if (parameter.count == 1) return one;
  const std::string array =
      "an array of " + std::to_string(parameter.count) + " numbers " + protocol::range_text(bounds);
  return parameter.one_for_all ? one + " or " + array : array;
}

protocol::Fault check(const ParameterKind& parameter, const std::string& path, const Numbers& numbers) {
  const Bounds bounds{parameter.range.min, parameter.range.max, parameter.range.unit};
  const bool one = numbers.size() == 1 && parameter.takes_one();
  if (!one && numbers.size() != parameter.count)
    return protocol::refuse("bad_type", path, numbers_json(numbers), kind_of(parameter, bounds));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] >= bounds.low && numbers[i] <= bounds.high) continue;
    return protocol::refuse("range", one ? path : pointer_to(path, std::to_string(i)),
                            number_json(numbers[i]), protocol::range_text(bounds));
  }
  return {};
}

/// "in aerodynamics only air_density, drag, lift".
template <class Known>
std::string known_in(const char* owner, const std::vector<Known>& known) {
  std::string names;
  for (const ParameterKind& parameter : known)
    names += (names.empty() ? " only " : ", ") + std::string(parameter.name);
  return "in " + std::string(owner) + (names.empty() ? " none" : names);
}

/// Gives `tuned`, which messages call `owner`, those of its known parameters that are given.
template <class Owner, class Known>
protocol::Fault tune_one(const protocol::Parameters& given, const char* owner,
                         const std::vector<Known>& known, Owner& tuned) {
  for (const auto& [name, numbers] : given) {
    const std::string path = pointer_to("/parameters", name);
    const auto parameter =
        std::find_if(known.begin(), known.end(),
                     [&wanted = name](const ParameterKind& each) { return each.name == wanted; });
    if (parameter == known.end())
      return protocol::refuse("unknown_member", path, numbers_json(numbers), known_in(owner, known));
    if (auto fault = check(*parameter, path, numbers)) return fault;
    Numbers all = numbers;
    all.resize(parameter->count, numbers[0]);
    parameter->write(tuned, all);
  }
  return {};
}

protocol::Error error_of(const protocol::JsonFault& fault) {
  return {std::nullopt, fault.code, fault.path, fault.message};
}

/// What a number may be.
json range_json(const ParameterKind& parameter) {
  const scene::Range& range = parameter.range;
  return {{"range", {number_json(range.min), number_json(range.max)}}, {"unit", range.unit}};
}

}  // namespace

std::optional<protocol::Error> tune(const protocol::EffectTune& command,
                                    std::vector<EffectDescription>& effects) {
  std::vector<EffectDescription> tuned = effects;
  for (EffectDescription& effect : tuned) {
    if (name_of(effect) != command.effect) continue;
    if (const auto fault =
            tune_one(command.parameters, name_of(effect), scene::parameters_of(effect), effect))
      return error_of(*fault);
  }
  effects = std::move(tuned);
  return {};
}

std::optional<protocol::Error> tune(const protocol::ClothTune& command,
                                    const std::vector<EffectDescription>& effects, Material& material) {
  Material tuned = material;
  if (const auto fault =
          tune_one(command.parameters, "the material", scene::material_parameters(effects), tuned))
    return error_of(*fault);
  material = tuned;
  return {};
}

json parameters_json(const EffectDescription& effect) {
  json parameters;
  for (const EffectParameter& parameter : scene::parameters_of(effect))
    parameters[parameter.name] = numbers_json(parameter.read(effect));
  return parameters;
}

json parameters_json(const std::vector<EffectDescription>& effects) {
  json all = json::object();
  for (const EffectDescription& effect : effects) {
    json parameters = parameters_json(effect);
    if (!parameters.is_null()) all[name_of(effect)] = std::move(parameters);
  }
  return all;
}

json tunable_json(const std::vector<EffectDescription>& effects) {
  json all = json::object();
  for (const EffectDescription& effect : effects) {
    for (const EffectParameter& parameter : scene::parameters_of(effect))
      all[name_of(effect)][parameter.name] = range_json(parameter);
  }
  return all;
}

json material_json(const Material& material, const std::vector<EffectDescription>& effects) {
  json numbers;
  for (const MaterialParameter& parameter : scene::material_parameters(effects))
    numbers[parameter.name] = numbers_json(parameter.read(material));
  return numbers;
}

json materials_json(const std::vector<Material>& materials, const std::vector<EffectDescription>& effects) {
  json all = json::array();
  for (const Material& material : materials) all.push_back(material_json(material, effects));
  return all;
}

json material_tunable_json(const std::vector<EffectDescription>& effects) {
  json all;
  for (const MaterialParameter& parameter : scene::material_parameters(effects)) {
    all[parameter.name] = range_json(parameter);
    if (parameter.effect != nullptr) all[parameter.name]["effect"] = parameter.effect;
  }
  return all;
}

}  // namespace weft::host
