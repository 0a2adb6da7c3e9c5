#include "runs.h"

#include <algorithm>
#include <array>
#include <set>

namespace weft::stability {
namespace {

constexpr std::array kMethods{Method::explicit_fixed, Method::symplectic_euler, Method::xpbd,
                              Method::backward_euler, Method::bdf2};

std::vector<int> step_rates(Method method) {
  const bool is_explicit = method == Method::explicit_fixed || method == Method::symplectic_euler;
  return is_explicit ? std::vector<int>{60} : std::vector<int>{60, 30, 15};
}

}  // namespace

std::string name_of(const HardRun& run) {
  return run.hard_case->name + "_" + name_of(run.setup.method) + "_L" + std::to_string(run.setup.level) +
         "_" + std::to_string(run.setup.hz) + "Hz";
}

std::vector<HardRun> all_runs() {
  std::vector<HardRun> runs;
  for (Case& each : all_cases()) {
    const auto hard_case = std::make_shared<const Case>(std::move(each));
    for (const int level : hard_case->levels) {
      for (const Method method : kMethods) {
        for (const int hz : step_rates(method)) runs.push_back({hard_case, {method, level, hz}});
      }
    }
  }
  return runs;
}

std::vector<HardRun> ci_runs() {
  // A day's length or seconds of frames at level 6.
  static const std::set<std::string> kSlow{"S13b", "S14", "S15"};
  std::vector<HardRun> runs = all_runs();
  std::erase_if(runs, [](const HardRun& run) {
    if (run.setup.level == run.hard_case->levels.front()) return false;
    const bool chosen = run.setup.method == Method::bdf2 || run.setup.method == Method::xpbd;
    return !chosen || run.setup.hz != 60 || kSlow.contains(run.hard_case->name);
  });
  return runs;
}

}  // namespace weft::stability
