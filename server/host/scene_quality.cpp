#include "host/scene_quality.h"

#include <algorithm>
#include <utility>

namespace weft::host {
namespace {

using nlohmann::json;
using study::Choice;

std::string label(const IntegratorDescription& integrator) {
  return std::string(study::name_of(integrator)) + ", " + study::setting_of(integrator);
}

json point_json(const Choice& choice, const study::LevelChoices& level) {
  const auto is = [&](const Choice& other) { return label(other.integrator) == label(choice.integrator); };
  return {{"integrator", study::name_of(choice.integrator)},
          {"setting", study::setting_of(choice.integrator)},
          {"ms", choice.milliseconds},
          {"error", choice.error},
          {"span", choice.span},
          {"best", std::any_of(level.front.begin(), level.front.end(), is)},
          {"own", level.own && is(*level.own)}};
}

json level_json(const study::LevelChoices& level) {
  json points = json::array();
  for (const Choice& choice : level.all) points.push_back(point_json(choice, level));
  return {
      {"level", level.level}, {"space", level.space}, {"floor", level.floor}, {"points", std::move(points)}};
}

}  // namespace

SceneQuality::SceneQuality(const scene::Quality& own, const IntegratorDescription& integrator)
    : own_(own),
      own_integrator_(integrator),
      own_label_(label(integrator)),
      wish_(own),
      in_use_(own_label_) {}

void SceneQuality::wish(const scene::Quality& wish) {
  wish_ = wish.asks() ? wish : own_;
  if (keeper_) keeper_->wish(wish_);
}

void SceneQuality::studied(StudyOutcome outcome) {
  studied_ = true;
  why_ = std::move(outcome.why);
  if (outcome.choices.levels.empty()) return;
  keeper_.emplace(std::move(outcome.choices));
  keeper_->want_level(wanted_level_);
  keeper_->wish(wish_);
}

void SceneQuality::outdated() {
  asked_ = studied_ = false;
  keeper_.reset();
}

void SceneQuality::want_level(int level) {
  wanted_level_ = level;
  if (keeper_) keeper_->want_level(level);
}

void SceneQuality::stepped(double milliseconds) {
  if (keeper_) keeper_->stepped(milliseconds);
}

std::optional<IntegratorDescription> SceneQuality::take_change() {
  if (!keeper_ && in_use_ == own_label_) return std::nullopt;
  const bool chosen = keeper_ && keeper_->choice();
  const IntegratorDescription& wanted = chosen ? keeper_->choice()->integrator : own_integrator_;
  if (label(wanted) == in_use_) return std::nullopt;
  in_use_ = label(wanted);
  return wanted;
}

void SceneQuality::go_on_with(const scene::Quality& wished) {
  wish(wished);
  if (wish_.asks()) in_use_.clear();
}

void SceneQuality::restarted() { in_use_ = own_label_; }

json SceneQuality::wish_json() const {
  json wish = json::object();
  if (wish_.max_error) wish["max_error"] = *wish_.max_error;
  if (wish_.max_ms) wish["max_ms"] = *wish_.max_ms;
  return wish;
}

json SceneQuality::stats_json() const {
  if (!asked_ && !studied_ && !wish_.asks()) return nullptr;
  json stats = {{"wish", wish_json()}};
  if (!keeper_) {
    stats["state"] = studied_ ? "unavailable" : "measuring";
    return stats;
  }
  stats["state"] = wish_.asks() ? "chosen" : "own";
  if (const auto& choice = keeper_->choice()) {
    stats["integrator"] = study::name_of(choice->integrator);
    stats["setting"] = study::setting_of(choice->integrator);
    stats["level"] = choice->level;
    stats["ms_expected"] = choice->milliseconds;
    stats["ms_measured"] = keeper_->measured_ms();
    stats["error_expected"] = choice->error;
    stats["span"] = choice->span;
    stats["space"] = keeper_->choices().at(choice->level)->space;
    stats["met"] = keeper_->met();
  }
  return stats;
}

std::string SceneQuality::curve_text() const {
  json message = {{"op", "curve"}, {"frames", 0}, {"chaotic", false}, {"levels", json::array()}};
  if (keeper_) {
    const study::Choices& choices = keeper_->choices();
    message["frames"] = choices.frames;
    message["chaotic"] = choices.chaotic;
    for (const auto& level : choices.levels) message["levels"].push_back(level_json(level));
  } else {
    message["why"] = why_;
  }
  return message.dump();
}

}  // namespace weft::host
