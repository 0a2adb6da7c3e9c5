#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "record/recording.h"

namespace weft::record {

/// A recording being done again, step by step.
class Replay {
 public:
  /// At the recording's beginning. Throws as Recording::scene.
  explicit Replay(const Recording& recording);

  const Simulation<float>& simulation() const { return simulation_; }
  /// Steps since the beginning.
  std::uint64_t steps() const { return steps_; }
  /// False where nothing is left.
  bool step();
  bool at_end() const { return next_ == recording_.events().size(); }
  /// Commands done so far, by steps and seeks.
  std::uint64_t commands() const { return commands_; }
  /// To so many steps since the beginning, or to the end: by the last state before, if it is ahead.
  void seek(std::uint64_t steps);
  /// What was told of the service last; empty if nothing was.
  std::string_view service() const { return service_; }

  /// Hashes met and found equal, so far.
  std::size_t hashes() const { return hashes_; }
  /// The first that was not, or a whole state that was not met.
  struct Divergence {
    std::uint64_t step = 0;                 ///< since the beginning
    std::uint64_t recorded = 0, found = 0;  ///< 0 of a state
  };
  const std::optional<Divergence>& divergence() const { return divergence_; }

 private:
  /// Does the events before the next step.
  void do_what_is_due();
  /// To an event and the steps before it.
  void go_to(std::size_t event, std::uint64_t steps);
  void diverged(std::uint64_t recorded, std::uint64_t found);

  const Recording& recording_;
  Simulation<float> simulation_;
  std::size_t next_ = 0;    ///< event
  std::uint32_t made_ = 0;  ///< of the event's steps
  std::uint64_t steps_ = 0, commands_ = 0;
  bool anywhere_ = true;  ///< the simulation is not where the recording is; a state comes next
  std::string_view service_;
  std::size_t hashes_ = 0;
  std::optional<Divergence> divergence_;
};

}  // namespace weft::record
