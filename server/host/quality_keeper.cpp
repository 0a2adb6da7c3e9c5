#include "host/quality_keeper.h"

#include <algorithm>

namespace weft::host {
namespace {

using study::Choice;
using study::LevelChoices;

/// Of one step in the mean: it forgets in a second or so.
constexpr double kWeight = 1.0 / 32;
/// One step says no more than this: the system's pauses are not the scene's.
constexpr double kOutlier = 4;
constexpr double kShortest = 1e-6;  // ms: no ratio is formed with less

bool better(const Choice& a, const Choice& b) {
  return a.level != b.level ? a.level > b.level : a.error < b.error;
}

bool same(const Choice& a, const Choice& b) {
  return a.level == b.level && a.error == b.error && a.milliseconds == b.milliseconds;
}

}  // namespace

void QualityKeeper::wish(const scene::Quality& wish) {
  wish_ = wish;
  choose_anew();
}

void QualityKeeper::want_level(int level) {
  if (wanted_level_ == level) return;
  wanted_level_ = level;
  choose_anew();
}

void QualityKeeper::choose_anew() {
  patience_ = kPatience;
  improved_ = false;
  const LevelChoices& level = *choices_.at(wanted_level_);
  if (wish_.max_error) {
    change_to(study::cheapest_within(level, *wish_.max_error).choice);
  } else if (wish_.max_ms) {
    change_to(best_within(*wish_.max_ms));
  } else if (level.own) {
    change_to(*level.own);
  } else {
    choice_.reset();
  }
}

void QualityKeeper::change_to(const Choice& choice) {
  if (choice_ && same(*choice_, choice)) return;
  choice_ = choice;
  steps_ = 0;
}

Choice QualityKeeper::best_within(double max_ms) const {
  const auto finest = std::find_if(choices_.levels.rbegin(), choices_.levels.rend(), [&](const auto& level) {
    return level.level == choices_.at(wanted_level_)->level;
  });
  Choice cheapest = finest->front.front();
  for (auto level = finest; level != choices_.levels.rend(); ++level) {
    const study::Pick pick = study::most_accurate_within(*level, max_ms, slowness_);
    if (pick.met) return pick.choice;
    if (pick.choice.milliseconds < cheapest.milliseconds) cheapest = pick.choice;
  }
  return cheapest;
}

void QualityKeeper::stepped(double milliseconds) {
  if (!choice_) return;
  const double ratio = milliseconds / std::max(choice_->milliseconds, kShortest);
  slowness_ += kWeight * (std::min(ratio, kOutlier * slowness_) - slowness_);
  ++steps_;
  if (wish_.max_ms && steps_ >= kSettling) keep(*wish_.max_ms);
}

void QualityKeeper::keep(double max_ms) {
  if (measured_ms() > max_ms) {
    const Choice next = best_within(max_ms);
    if (same(next, *choice_)) return;
    const bool tried_in_vain = improved_ && steps_ < patience_;
    patience_ = tried_in_vain ? std::min(2 * patience_, kMostPatience) : kPatience;
    improved_ = false;
    change_to(next);
  } else if (steps_ >= patience_) {
    const Choice next = best_within(kMargin * max_ms);
    if (!better(next, *choice_)) return;
    improved_ = true;
    change_to(next);
  }
}

std::optional<int> QualityKeeper::level_cap() const {
  if (!wish_.max_ms || choice_->level >= choices_.at(wanted_level_)->level) return std::nullopt;
  return choice_->level;
}

bool QualityKeeper::met() const {
  if (wish_.max_error) return choice_->error <= *wish_.max_error;
  if (wish_.max_ms) return measured_ms() <= *wish_.max_ms;
  return true;
}

}  // namespace weft::host
