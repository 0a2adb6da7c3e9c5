#include "record/recording.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "cloth/world/description_archive.h"
#include "record/chunks.h"

namespace weft::record {

Recording Recording::of_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw std::runtime_error(file + ": " + std::strerror(errno));
  try {
    return Recording(std::move(text));
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(file + ": " + fault.what());
  }
}

Recording Recording::of_text(std::string text) { return Recording(std::move(text)); }

Recording::Recording(std::string text) : text_(std::make_unique<const std::string>(std::move(text))) {
  ChunkReader reader(*text_);
  const auto first = reader.next();
  if (!first || first->kind != ChunkKind::scene)
    throw std::invalid_argument(reader.damage().empty() ? "it names no scene" : reader.damage());
  head_ = nlohmann::json::parse(first->bytes, nullptr, false);
  if (!head_.is_object() || !head_.contains("document") || !head_["document"].is_string())
    throw std::invalid_argument("it names no scene");
  try {
    while (const auto chunk = reader.next()) {
      if (chunk->kind == ChunkKind::commands) {
        read_commands(chunk->bytes);
      } else if (chunk->kind == ChunkKind::state) {
        events_.emplace_back(StateThen{chunk->bytes});
      } else if (chunk->kind == ChunkKind::hash) {
        HashThen then{};
        StateReader numbers(chunk->bytes);
        numbers(then.hash);
        events_.emplace_back(then);
      } else if (chunk->kind == ChunkKind::service) {
        events_.emplace_back(ServiceThen{chunk->bytes});
      }
    }
    damage_ = reader.damage();
  } catch (const std::exception& fault) {  // right by its checksum, but of another build
    damage_ = fault.what();
  }
}

void Recording::read_commands(std::string_view bytes) {
  std::vector<command::Command> commands;
  StateReader reader(bytes);
  reader(commands);
  for (command::Command& each : commands) {
    const auto* made = std::get_if<command::Steps>(&each);
    if (made != nullptr) {
      steps_ += made->count;
    } else {
      ++commands_;
    }
    events_.emplace_back(std::move(each));
  }
}

scene::Scene Recording::scene() const {
  const auto text = [&](const char* member) {
    return head_.contains(member) && head_[member].is_string() ? head_[member].get<std::string>() : "";
  };
  scene::Result read = scene::parse_beside(text("document"), text("name"), text("folder"));
  if (auto* scene = std::get_if<scene::Scene>(&read)) return std::move(*scene);
  throw std::invalid_argument("its scene: " + std::get<std::vector<scene::Problem>>(read).front().text());
}

}  // namespace weft::record
