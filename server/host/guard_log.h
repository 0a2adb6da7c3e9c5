#pragma once
/// What viewers and the log are told of the step guard's doings in one scene.
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/metrics.h"

namespace weft::host {

/// Of one scene, since it was loaded or reset; no clock.
class GuardLog {
 public:
  /// Of recoveries at most one is told in so many steps, and of steps that let cloth through cloth; the
  /// others are counted.
  static constexpr std::uint64_t kQuietSteps = 60;

  /// A notice of PROTOCOL.md section 3.
  struct Notice {
    std::string code, message;
  };
  /// What is to be told of the simulation's last step.
  std::vector<Notice> stepped(const Simulation<float>& simulation);
  /// What a viewer is told who comes now: a notice for each cloth that is frozen.
  std::vector<Notice> standing() const;
  /// How often each thing has happened.
  SceneMetrics::Guard counts() const { return {redone_, frozen_, balls_stopped_, crowded_}; }
  /// `stats`' member `guard`; null while nothing has happened.
  nlohmann::json stats_json() const;

 private:
  /// Of what is told at most once in a while.
  struct Rare {
    std::uint64_t quiet_until = 0;  ///< step
    int untold = 0;                 ///< since the last that was told
  };

  std::uint64_t redone_ = 0, frozen_ = 0, balls_stopped_ = 0, crowded_ = 0;
  std::map<std::size_t, std::string> frozen_cloths_;  ///< what was told of each
  Rare recoveries_, crowds_;
};

}  // namespace weft::host
