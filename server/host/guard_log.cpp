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
    const bool thawed = event.action == Action::thawed, crowded = event.action == Action::let_through;
    if (thawed) frozen_cloths_.erase(event.cloth);
    if (crowded) ++crowded_;
    Rare& rare = crowded ? crowds_ : recoveries_;
    if (!thawed && event.step < rare.quiet_until) {
      ++rare.untold;
      continue;
    }
    if (rare.untold > 0) message += " (" + std::to_string(rare.untold) + " more like it before)";
    rare = {event.step + kQuietSteps, 0};
    notices.push_back({crowded ? "crowded" : "recovered", std::move(message)});
  }
  return notices;
}

std::vector<GuardLog::Notice> GuardLog::standing() const {
  std::vector<Notice> notices;
  for (const auto& [cloth, message] : frozen_cloths_) notices.push_back({"frozen", message});
  return notices;
}

nlohmann::json GuardLog::stats_json() const {
  if (redone_ + frozen_ + balls_stopped_ + crowded_ == 0) return nullptr;
  return {{"redone", redone_}, {"frozen", frozen_}, {"balls_stopped", balls_stopped_}, {"crowded", crowded_}};
}

}  // namespace weft::host
