#include "record/recording.h"

#include <stdexcept>

#include "record/chunks.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

/// What is no recording says so; what is damaged is read up to there.
void read_recording(std::string text) {
  try {
    const record::Recording recording = record::Recording::of_text(std::move(text));
    std::uint64_t commands = 0;
    for (const record::Event& event : recording.events())
      commands += std::holds_alternative<command::Command>(event) ? 1 : 0;
    require(commands >= recording.commands(), "each command is an event");
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

// As a file, and, since hardly any mutation keeps its checksums, as the commands of one whose checksums are
// right.
void recordings(Input input) {
  read_recording(text_of(input));
  std::string text(record::kMark);
  record::append_chunk(text, {record::ChunkKind::scene, R"({"document": "{}"})"});
  record::append_chunk(text, {record::ChunkKind::commands, text_of(input)});
  read_recording(std::move(text));
}

}  // namespace weft::fuzz
