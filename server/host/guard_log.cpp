#include "host/guard_log.h"

namespace weft::host {

using Action = GuardEvent::Action;

std::vector<GuardLog::Notice> GuardLog::stepped(const Simulation<float>& simulation) {
  std::vector<Notice> notices;
  for (const GuardEvent& event : simulation.guard_events()) {
    std::string message = describe(event, simulation.cloths()[event.cloth].description().name);
    if (event.action == Action::frozen) {
      ++frozen_;
      frozen_cloths_[event.cloth] = message;
      notices.push_back({"frozen", std::move(message)});
      continue;
    }
    if (event.action == Action::redone) ++redone_;
    if (event.action == Action::ball_stopped) ++balls_stopped_;
    const bool thawed = event.action == Action::thawed;
    if (thawed) frozen_cloths_.erase(event.cloth);
    if (!thawed && event.step < quiet_until_) {
      ++untold_;
      continue;
    }
    if (untold_ > 0) message += " (" + std::to_string(untold_) + " more like it before)";
    untold_ = 0;
    quiet_until_ = event.step + kQuietSteps;
    notices.push_back({"recovered", std::move(message)});
  }
  return notices;
}

std::vector<GuardLog::Notice> GuardLog::standing() const {
  std::vector<Notice> notices;
  for (const auto& [cloth, message] : frozen_cloths_) notices.push_back({"frozen", message});
  return notices;
}

nlohmann::json GuardLog::stats_json() const {
  if (redone_ + frozen_ + balls_stopped_ == 0) return nullptr;
  return {{"redone", redone_}, {"frozen", frozen_}, {"balls_stopped", balls_stopped_}};
}

}  // namespace weft::host
