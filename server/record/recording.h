#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "cloth/world/command.h"
#include "scene/scene.h"

namespace weft::record {

struct StateThen {
  std::string_view bytes;  ///< of the recording
};
struct HashThen {
  std::uint64_t hash;
};
struct ServiceThen {
  std::string_view bytes;
};
using Event = std::variant<command::Command, StateThen, HashThen, ServiceThen>;

/// A recording, up to where it is damaged if it is. Owns its bytes.
class Recording {
 public:
  /// Throws std::invalid_argument, saying what is wrong, if it is none, or damaged so early that it names no
  /// scene; std::runtime_error if the file cannot be read.
  static Recording of_file(const std::string& file);
  static Recording of_text(std::string text);

  /// The scene that was recorded. Throws std::invalid_argument if it has problems here.
  scene::Scene scene() const;
  /// What the recorder was given beside it.
  const nlohmann::json& head() const { return head_; }
  const std::vector<Event>& events() const { return events_; }
  /// Where and how it is damaged; empty if it is not.
  const std::string& damage() const { return damage_; }
  std::uint64_t steps() const { return steps_; }
  std::size_t commands() const { return commands_; }

  Recording(Recording&&) = default;

 private:
  explicit Recording(std::string text);
  void read_commands(std::string_view bytes);

  std::unique_ptr<const std::string> text_;  ///< which events point into
  nlohmann::json head_;
  std::vector<Event> events_;
  std::string damage_;
  std::uint64_t steps_ = 0;
  std::size_t commands_ = 0;  ///< but for steps
};

}  // namespace weft::record
