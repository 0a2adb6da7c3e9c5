#include "study/quality.h"

#include <algorithm>
#include <numeric>

namespace weft::study {
namespace {

/// LevelChoices::front, of runs from cheap to dear of which none beats another over the shorter span.
std::vector<Choice> front_of(const std::vector<Choice>& best) {
  const auto dearest_followed = std::max_element(
      best.rbegin(), best.rend(), [](const Choice& a, const Choice& b) { return a.span < b.span; });
  std::vector<Choice> front;
  for (auto choice = best.begin(); choice != best.end(); ++choice) {
    if (choice < dearest_followed.base() && choice->span < dearest_followed->span) continue;
    if (front.empty() || choice->error < front.back().error) front.push_back(*choice);
  }
  return front;
}

LevelChoices choices_of(const Study& study, const LevelStudy& level) {
  LevelChoices choices;
  choices.level = level.level;
  if (!level.reference.usable()) return choices;
  choices.space = study.judged(level.space);
  choices.floor = study.floor(level.reference);
  std::vector<Choice> best;
  for (const Run& run : level.runs) {
    if (run.status != Run::Status::done) continue;
    const int frames = run.followed ? study.followed_frames : study.frames;
    const Choice choice{level.level, run.candidate.integrator, run.milliseconds,
                        std::max(run.followed.value_or(study.judged(run.time)), choices.floor),
                        frames * study.time_step};
    choices.all.push_back(choice);
    if (run.best) best.push_back(choice);
    if (run.candidate.present) choices.own = choice;
  }
  const auto cheaper = [](const Choice& a, const Choice& b) { return a.milliseconds < b.milliseconds; };
  std::stable_sort(choices.all.begin(), choices.all.end(), cheaper);
  std::stable_sort(best.begin(), best.end(), cheaper);
  choices.front = front_of(best);
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
