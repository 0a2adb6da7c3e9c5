#include <utility>

#include "scene/effect_parameters.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kSubsteps{1, 10000};

/// "substeps": a number, or "auto", which leaves them as they are.
void read_chosen_substeps(Object& object, int& number) {
  const json* substeps = object.find("substeps");
  if (!substeps || *substeps == "auto") return;
  if (substeps->is_string()) {
    object.report().refuse(*substeps, object.path("substeps"), "\"auto\" or an integer " + kSubsteps.text());
  } else {
    object.integer("substeps", number, kSubsteps);
  }
}

SymplecticEulerDescription read_symplectic_euler(Object& object) {
  constexpr Range kSafety{0.01, 1};
  SymplecticEulerDescription euler;
  read_chosen_substeps(object, euler.substeps);
  object.number("safety", euler.safety, kSafety);
  return euler;
}

XpbdDescription read_xpbd(Object& object) {
  constexpr Range kLongestSubstep{1e-5, 0.1, "s"};
  XpbdDescription xpbd;
  read_chosen_substeps(object, xpbd.substeps);
  object.number("longest_substep", xpbd.longest_substep, kLongestSubstep);
  return xpbd;
}

template <class Description>
Description read_implicit(Object& object) {
  constexpr Range kTolerance{1e-12, 1};
  constexpr Range kNewtonIterations{1, 100};
  constexpr Range kLinearIterations{1, 10000};
  constexpr Range kLiveliness{0, 1};
  Description implicit;
  object.integer("substeps", implicit.substeps, kSubsteps);
  object.number("tolerance", implicit.tolerance, kTolerance);
  object.integer("newton_iterations", implicit.newton_iterations, kNewtonIterations);
  object.integer("linear_iterations", implicit.linear_iterations, kLinearIterations);
  object.number("liveliness", implicit.liveliness, kLiveliness);
  return implicit;
}

/// The effect that the object's type names, with its own defaults.
template <std::size_t... kIndex>
std::optional<EffectDescription> read_type(Object& object, std::index_sequence<kIndex...>) {
  const EffectDescription blank[] = {EffectDescription(std::in_place_index<kIndex>)...};
  const int chosen = object.choice("type", {std::variant_alternative_t<kIndex, EffectDescription>::kName...});
  if (chosen < 0) return {};
  return blank[chosen];
}

/// Those of the effect's parameters that the object gives.
void read_parameters(Object& object, EffectDescription& effect) {
  for (const EffectParameter& parameter : parameters_of(effect)) {
    const json* given = object.find(parameter.name);
    std::vector<double> values(parameter.count);
    if (parameter.takes_one() && (given == nullptr || !given->is_array())) {
      if (!object.number(parameter.name, values[0], parameter.range)) continue;
      values.assign(parameter.count, values[0]);
    } else if (!object.numbers(parameter.name, values.data(), parameter.count, parameter.range)) {
      continue;
    }
    parameter.write(effect, values);
  }
}

}  // namespace

std::optional<EffectDescription> read_effect(const json& value, const std::string& path, Report& report) {
  constexpr std::size_t kTypes = std::variant_size_v<EffectDescription>;
  Object object(value, path, report);
  object.require("type", "an effect's name");
  std::optional<EffectDescription> effect = read_type(object, std::make_index_sequence<kTypes>());
  if (!effect) {
    object.ignore_rest();
    return effect;
  }
  auto* inflation = std::get_if<InflationEffect>(&*effect);
  if (inflation != nullptr && object.has("volume"))
    inflation->volume = 0;  // of gas, which has other parameters
  read_parameters(object, *effect);
  if (inflation != nullptr && !inflation->volume && object.has("fill_time"))
    object.problem("fill_time", "is given without volume; a pressure that is kept up is there at once");
  if (auto* wind = std::get_if<PaperWindEffect>(&*effect)) object.boolean("along_normal", wind->along_normal);
  return effect;
}

IntegratorDescription read_integrator(const json& value, const std::string& path, Report& report) {
  Object object(value, path, report);
  object.require("type", "an integrator's name");
  switch (object.choice("type", {SymplecticEulerDescription::kName, BackwardEulerDescription::kName,
                                 Bdf2Description::kName, XpbdDescription::kName})) {
    case 0:
      return read_symplectic_euler(object);
    case 1:
      return read_implicit<BackwardEulerDescription>(object);
    case 2:
      return read_implicit<Bdf2Description>(object);
    case 3:
      return read_xpbd(object);
    default:
      object.ignore_rest();
      return {};
  }
}

Quality read_quality(const json& value, const std::string& path, Report& report) {
  constexpr Range kError{1e-6, 1};
  constexpr Range kMilliseconds{0.01, 1000, "ms"};
  Object object(value, path, report);
  Quality quality;
  const bool by_error = object.has("max_error"), by_time = object.has("max_ms");
  double bound = 0;
  if (object.number("max_error", bound, kError)) quality.max_error = bound;
  if (object.number("max_ms", bound, kMilliseconds)) quality.max_ms = bound;
  if (value.is_object() && by_error == by_time) {
    report.add(path, std::string(by_error ? "has both max_error and" : "has neither max_error nor") +
                         " max_ms; must have exactly one of them");
  }
  return quality;
}

LevelPolicy read_level_policy(const json& value, const std::string& path, Report& report) {
  constexpr Range kThreshold{1e-4, 1e6, "m"};
  constexpr Range kHysteresis{0, 0.9};
  constexpr std::size_t kMostLevels = kMaxLevel - kMinLevel + 1;
  LevelPolicy policy;
  Object object(value, path, report);
  if (object.has("thresholds")) {
    policy.thresholds.clear();
    object.each("thresholds", 0, kMostLevels - 1, [&](const json& each, const std::string& at) {
      const auto threshold = read_number(each, at, kThreshold, report);
      if (!threshold) return;
      if (!policy.thresholds.empty() && *threshold <= policy.thresholds.back()) {
        report.refuse(each, at, "above the one before; thresholds ascend");
      }
      policy.thresholds.push_back(*threshold);
    });
  }
  if (object.has("levels")) {
    policy.levels.clear();
    object.each("levels", 1, kMostLevels, [&](const json& each, const std::string& at) {
      if (!each.is_number_integer() || each < kMinLevel || each > kMaxLevel) {
        report.refuse(each, at, "an integer " + kLevel.text());
        return;
      }
      const int level = each.get<int>();
      if (!policy.levels.empty() && level >= policy.levels.back()) {
        report.refuse(each, at, "below the one before; levels descend with distance");
      }
      policy.levels.push_back(level);
    });
  }
  const json* thresholds = object.find("thresholds");
  const json* levels = object.find("levels");
  const std::size_t bands =
      1 + (thresholds && thresholds->is_array() ? thresholds->size() : policy.thresholds.size());
  const std::size_t count = levels && levels->is_array() ? levels->size() : policy.levels.size();
  if (count != bands) {
    report.add(path, "has " + std::to_string(count) + " levels; must be " + std::to_string(bands) +
                         ", one more than thresholds");
  }
  object.number("hysteresis", policy.hysteresis, kHysteresis);
  return policy;
}

}  // namespace weft::scene
