#pragma once
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cloth/world/state.h"
#include "host/playing.h"
#include "record/recorder.h"
#include "record/replay.h"

namespace weft::host {

/// A simulation that all can look at, and that only commands (cloth/world/command.h) and steps change:
/// recorders are told of each. Or one that plays a recording, which its own steps alone change.
class RecordedSimulation {
 public:
  RecordedSimulation(const SimulationDescription& description, const std::optional<Playing>& playing) {
    if (!playing) {
      own_ = std::make_unique<Simulation<float>>(description);
      return;
    }
    playing_ = *playing;
    replay_ = std::make_unique<record::Replay>(*playing_.recording);
    replay_->seek(playing_.from);
  }

  /// Stays where it is.
  const Simulation<float>& simulation() const { return replay_ ? replay_->simulation() : *own_; }
  /// A command does nothing to a recording, but for Reset: it begins anew.
  template <class Command>
  auto run(const Command& command) {
    using Result = decltype(command.carry_out(*own_));
    if (replay_) {
      if constexpr (std::is_same_v<Command, command::Reset>) replay_->seek(playing_.from);
      return Result();
    }
    for (const auto& recorder : recorders_) recorder->add(command);
    return command.carry_out(*own_);
  }
  void step() {
    if (replay_) {
      replay_->step();
      return;
    }
    own_->step();
    for (const auto& recorder : recorders_) recorder->stepped(*own_);
  }
  /// Is in this state now (load_state).
  void load(std::string_view state) { load_state(*own_, state); }
  /// What comes is told to these.
  void record(std::vector<std::shared_ptr<record::Recorder>> recorders) { recorders_ = std::move(recorders); }

  /// The recording that it plays, or nullptr.
  const record::Replay* replay() const { return replay_.get(); }
  bool loops() const { return playing_.loop; }

 private:
  std::unique_ptr<Simulation<float>> own_;  ///< or else replay_
  Playing playing_;
  std::unique_ptr<record::Replay> replay_;
  std::vector<std::shared_ptr<record::Recorder>> recorders_;
};

}  // namespace weft::host
