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

std::vector<Setup> setups(int level) {
  std::vector<Setup> all;
  for (const Method method : kMethods) {
    for (const int hz : step_rates(method)) all.push_back({method, level, hz});
  }
  return all;
}

/// Their shortest runs take tens of seconds: left to the nightly tests.
const std::set<std::string> kLongCases{"S11b", "S51b", "S51d"};

bool is_every_fifth(std::size_t index) { return index % 5 == 0; }

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
      for (const Setup& setup : setups(level)) runs.push_back({hard_case, setup});
    }
  }
  return runs;
}

std::vector<HardRun> sample_runs() {
  std::vector<HardRun> runs;
  for (Case& each : all_cases()) {
    if (kLongCases.contains(each.name)) continue;
    const auto hard_case = std::make_shared<const Case>(std::move(each));
    const std::vector<Setup> choice = setups(hard_case->levels.front());
    runs.push_back({hard_case, choice[runs.size() % choice.size()]});
  }
  return runs;
}

std::vector<HardRun> every_fifth(std::vector<HardRun> runs) {
  std::size_t index = 0;
  std::erase_if(runs, [&](const HardRun&) { return !is_every_fifth(index++); });
  return runs;
}

std::vector<HardRun> all_but_every_fifth(std::vector<HardRun> runs) {
  std::size_t index = 0;
  std::erase_if(runs, [&](const HardRun&) { return is_every_fifth(index++); });
  return runs;
}

std::vector<HardRun> coarsest_runs() {
  std::vector<HardRun> runs = all_runs();
  std::erase_if(runs, [](const HardRun& run) { return run.setup.level != run.hard_case->levels.front(); });
  return runs;
}

}  // namespace weft::stability
