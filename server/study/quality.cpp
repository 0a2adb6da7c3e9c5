#include "study/quality.h"

#include <algorithm>
#include <numeric>

namespace weft::study {
namespace {

LevelChoices choices_of(const Study& study, const LevelStudy& level) {
  LevelChoices choices;
  choices.level = level.level;
  if (!level.reference.usable()) return choices;
  choices.space = study.judged(level.space);
  choices.floor = study.floor(level.reference);
  for (const Run& run : level.runs) {
    if (run.status != Run::Status::done) continue;
    const Choice choice{level.level, run.candidate.integrator, run.milliseconds,
                        std::max(study.judged(run.time), choices.floor)};
    choices.all.push_back(choice);
    if (run.best) choices.front.push_back(choice);
    if (run.candidate.present) choices.own = choice;
  }
  const auto cheaper = [](const Choice& a, const Choice& b) { return a.milliseconds < b.milliseconds; };
  std::stable_sort(choices.all.begin(), choices.all.end(), cheaper);
  std::stable_sort(choices.front.begin(), choices.front.end(), cheaper);
  // Equals in both are all on a Pareto front; one of them is enough to choose from.
  const auto same_error = [](const Choice& a, const Choice& b) { return a.error == b.error; };
  choices.front.erase(std::unique(choices.front.begin(), choices.front.end(), same_error),
                      choices.front.end());
  return choices;
}

}  // namespace

const LevelChoices* Choices::at(int level) const {
  const auto nearer = [level](const LevelChoices& a, const LevelChoices& b) {
    return std::abs(a.level - level) < std::abs(b.level - level);
  };
  const auto nearest = std::min_element(levels.begin(), levels.end(), nearer);
  return nearest == levels.end() ? nullptr : &*nearest;
}

Choices choices_of(const Study& study) {
  Choices choices;
  choices.chaotic = study.chaotic;
  choices.frames = study.frames;
  for (const LevelStudy& level : study.levels) {
    LevelChoices of_level = choices_of(study, level);
    if (!of_level.front.empty()) choices.levels.push_back(std::move(of_level));
  }
  return choices;
}

Pick cheapest_within(const LevelChoices& level, double max_error) {
  const auto found = std::find_if(level.front.begin(), level.front.end(),
                                  [&](const Choice& choice) { return choice.error <= max_error; });
  if (found == level.front.end()) return {level.front.back(), false};
  return {*found, true};
}

Pick most_accurate_within(const LevelChoices& level, double max_ms, double slowness) {
  const auto found = std::find_if(level.front.rbegin(), level.front.rend(), [&](const Choice& choice) {
    return slowness * choice.milliseconds <= max_ms;
  });
  if (found == level.front.rend()) return {level.front.front(), false};
  return {*found, true};
}

std::vector<int> levels_of(const SimulationDescription& description) {
  int low = kMaxLevel, high = kMinLevel;
  for (const ClothDescription& cloth : description.cloths) {
    low = std::min(low, cloth.min_level);
    high = std::max(high, cloth.max_level);
  }
  std::vector<int> levels(static_cast<std::size_t>(high - low + 1));
  std::iota(levels.begin(), levels.end(), low);
  return levels;
}

}  // namespace weft::study
