#pragma once
/// What a run tells at its end: lines for people, or JSON for programs.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/guard_log.h"

namespace weft::cli {

/// Wall time of the steps alone.
struct StepTimes {
  double time_step = 0;  ///< s of the scene
  int steps = 0;
  int slow = 0;                     ///< those that took longer than the time they make
  double seconds = 0, longest = 0;  ///< s
  int longest_frame = 0;            ///< that the longest step ended with; 0: no step was made

  void add(int frame, double step_seconds);
  double mean_ms() const { return steps > 0 ? 1e3 * seconds / steps : 0.0; }
  double longest_ms() const { return 1e3 * longest; }
};

struct RunSummary {
  const std::string& scene;  ///< name
  const Simulation<float>& simulation;
  const StepTimes& times;
  const host::GuardLog& guard;
  std::optional<std::uint64_t> hash;  ///< if asked for
  std::vector<std::string> files;     ///< written

  std::string text() const;
  /// The members are listed in server/docs/operations.md.
  nlohmann::ordered_json json() const;
};

}  // namespace weft::cli
