#include "study/candidate.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace weft::study {
namespace {

using Settings = std::vector<IntegratorDescription>;

std::string text_of(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return {digits, end};
}

std::string substeps_text(int substeps) {
  return std::to_string(substeps) + (substeps == 1 ? " substep" : " substeps");
}

struct SettingText {
  std::string operator()(const SymplecticEulerDescription& euler) const {
    if (euler.substeps > 0) return substeps_text(euler.substeps);
    return text_of(euler.safety) + " of the stability limit";
  }
  std::string operator()(const ImplicitParameters& implicit) const {
    std::string text = substeps_text(implicit.substeps) + ", tolerance " + text_of(implicit.tolerance);
    if (implicit.newton_iterations > 1) text += ", " + std::to_string(implicit.newton_iterations) + " Newton";
    return text;
  }
  std::string operator()(const XpbdDescription& xpbd) const {
    if (xpbd.substeps > 0) return substeps_text(xpbd.substeps);
    return "substeps of " + text_of(std::round(1e6 * xpbd.longest_substep)) + " us";
  }
};

Settings symplectic_euler_settings() {
  Settings settings;
  for (const double share : {1.0, 0.5, 0.25}) {
    SymplecticEulerDescription euler;
    euler.safety *= share;
    settings.emplace_back(euler);
  }
  return settings;
}

Settings xpbd_settings() {
  Settings settings;
  for (const int substeps : {5, 10, 20, 40, 80, 160}) settings.emplace_back(XpbdDescription{substeps});
  return settings;
}

template <class Description>
Settings implicit_settings() {
  Description loose, usual, close, tight;
  loose.tolerance = 0.3;
  loose.newton_iterations = 1;
  close.tolerance = 0.01;
  tight.tolerance = 0.001;
  tight.newton_iterations = 3;
  Settings settings;
  const auto add = [&](Description description, std::initializer_list<int> substeps) {
    for (const int each : substeps) {
      description.substeps = each;
      settings.emplace_back(description);
    }
  };
  add(loose, {1, 2});
  add(usual, {1, 2, 4});
  add(close, {1, 2, 4});
  add(tight, {1, 2, 4, 8, 16});
  return settings;
}

Settings settings_of(std::string_view name) {
  if (name == SymplecticEulerDescription::kName) return symplectic_euler_settings();
  if (name == XpbdDescription::kName) return xpbd_settings();
  if (name == BackwardEulerDescription::kName) return implicit_settings<BackwardEulerDescription>();
  return implicit_settings<Bdf2Description>();
}

bool same(const IntegratorDescription& a, const IntegratorDescription& b) {
  return a.index() == b.index() && setting_of(a) == setting_of(b);
}

}  // namespace

const std::vector<std::string_view>& integrator_names() {
  static const std::vector<std::string_view> names = {Bdf2Description::kName, BackwardEulerDescription::kName,
                                                      XpbdDescription::kName,
                                                      SymplecticEulerDescription::kName};
  return names;
}

std::string_view name_of(const IntegratorDescription& integrator) {
  return std::visit([](const auto& each) { return std::string_view(each.kName); }, integrator);
}

std::string setting_of(const IntegratorDescription& integrator) {
  return std::visit(SettingText{}, integrator);
}

std::vector<Candidate> candidates(const std::vector<std::string_view>& names,
                                  const IntegratorDescription& present) {
  std::vector<Candidate> all{{present, true}};
  std::vector<Settings> settings;
  std::size_t rounds = 0;
  for (const std::string_view name : names) {
    rounds = std::max(rounds, settings.emplace_back(settings_of(name)).size());
  }
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const Settings& each : settings) {
      if (round < each.size() && !same(each[round], present)) all.push_back({each[round]});
    }
  }
  return all;
}

}  // namespace weft::study
