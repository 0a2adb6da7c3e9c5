#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cloth/world/command.h"
#include "scene/scene.h"

namespace weft::record {

/// Writes down what is done to one simulation, in chunks (chunks.h), for Recording to read. Used by the
/// simulation's thread alone.
class Recorder {
 public:
  /// Takes bytes that belong behind those before.
  using Sink = std::function<void(std::string bytes)>;
  /// Steps from hash to hash.
  static constexpr std::uint64_t kHashSteps = 60;

  /// Begins a recording with the scene and `more` members beside it.
  Recorder(const scene::Scene& scene, const nlohmann::json& more, Sink sink);

  void add(command::Command command);
  /// A step was made.
  void stepped(const Simulation<float>& simulation);
  /// The simulation is in this state now, whatever came before.
  void add_state(const Simulation<float>& simulation);
  /// By which a state that is read is checked.
  void add_hash(const Simulation<float>& simulation);
  /// What is served beside the simulation is so now.
  void add_service(std::string_view service);
  /// Told so far.
  std::uint64_t steps() const { return steps_; }
  /// Hands all that was added to the sink.
  void flush();

 private:
  /// Commands and steps so far become a chunk.
  void end_commands();

  Sink sink_;
  std::vector<command::Command> commands_;
  std::string bytes_;
  std::uint64_t steps_ = 0;
};

}  // namespace weft::record
