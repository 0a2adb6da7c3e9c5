#include "runs.h"

#include <algorithm>
#include <array>
#include <functional>
#include <set>

namespace weft::stability {
namespace {

constexpr std::array kMethods{Method::explicit_fixed, Method::symplectic_euler, Method::xpbd,
                              Method::backward_euler, Method::bdf2};

std::vector<int> step_rates(Method method) {
  const bool is_explicit = method == Method::explicit_fixed || method == Method::symplectic_euler;
  return is_explicit ? std::vector<int>{60} : std::vector<int>{60, 30, 15};
}

constexpr int kFinest = 6;

bool is_lowest(const HardRun& run) { return run.setup.level == run.hard_case->levels.front(); }

/// The default integrator and XPBD, as a scene is stepped, but for cases of a day's length, of seconds of
/// frames at level 6, or of a minute at level 5.
bool is_usual(const HardRun& run) {
  static const std::set<std::string> kSlow{"S13b", "S14a", "S14b", "S15", "S51b", "S51c", "S51d"};
  const bool chosen = run.setup.method == Method::bdf2 || run.setup.method == Method::xpbd;
  return chosen && run.setup.hz == 60 && !kSlow.contains(run.hard_case->name);
}

std::vector<HardRun> chosen(const std::function<bool(const HardRun&)>& is_chosen) {
  std::vector<HardRun> runs = all_runs();
  std::erase_if(runs, std::not_fn(is_chosen));
  return runs;
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

std::vector<HardRun> coarsest_runs() { return chosen(is_lowest); }

std::vector<HardRun> finer_runs() {
  return chosen(
      [](const HardRun& run) { return !is_lowest(run) && is_usual(run) && run.setup.level < kFinest; });
}

std::vector<HardRun> finest_runs() {
  return chosen(
      [](const HardRun& run) { return !is_lowest(run) && is_usual(run) && run.setup.level == kFinest; });
}

}  // namespace weft::stability
