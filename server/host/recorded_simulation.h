#pragma once
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "cloth/world/state.h"
#include "record/recorder.h"

namespace weft::host {

/// A simulation that all can look at, and that only commands (cloth/world/command.h) and steps change:
/// recorders are told of each.
class RecordedSimulation {
 public:
  explicit RecordedSimulation(const SimulationDescription& description) : simulation_(description) {}

  const Simulation<float>& simulation() const { return simulation_; }
  template <class Command>
  auto run(const Command& command) {
    for (const auto& recorder : recorders_) recorder->add(command);
    return command.carry_out(simulation_);
  }
  void step() {
    simulation_.step();
    for (const auto& recorder : recorders_) recorder->stepped(simulation_);
  }
  /// Is in this state now (load_state).
  void load(std::string_view state) { load_state(simulation_, state); }
  /// What comes is told to these.
  void record(std::vector<std::shared_ptr<record::Recorder>> recorders) { recorders_ = std::move(recorders); }

 private:
  Simulation<float> simulation_;
  std::vector<std::shared_ptr<record::Recorder>> recorders_;
};

}  // namespace weft::host
