#include "record/recorder.h"

#include <utility>

#include "cloth/world/description_archive.h"
#include "cloth/world/state.h"
#include "cloth/world/state_hash.h"
#include "record/chunks.h"

namespace weft::record {

Recorder::Recorder(const scene::Scene& scene, const nlohmann::json& more, Sink sink)
    : sink_(std::move(sink)), bytes_(kMark) {
  nlohmann::json all = more;
  all["name"] = scene.name;
  all["document"] = scene.document;
  all["folder"] = scene.folder;
  append_chunk(bytes_, {ChunkKind::scene, all.dump()});
}

void Recorder::add(command::Command command) { commands_.push_back(std::move(command)); }

void Recorder::stepped(const Simulation<float>& simulation) {
  auto* last = commands_.empty() ? nullptr : std::get_if<command::Steps>(&commands_.back());
  if (last != nullptr) {
    ++last->count;
  } else {
    commands_.emplace_back(command::Steps{1});
  }
  if (++steps_ % kHashSteps == 0) add_hash(simulation);
}

void Recorder::add_hash(const Simulation<float>& simulation) {
  end_commands();
  std::string hash;
  StateWriter writer(hash);
  writer(state_hash(simulation));
  append_chunk(bytes_, {ChunkKind::hash, hash});
}

void Recorder::add_state(const Simulation<float>& simulation) {
  end_commands();
  append_chunk(bytes_, {ChunkKind::state, save_state(simulation)});
}

void Recorder::add_service(std::string_view service) {
  end_commands();
  append_chunk(bytes_, {ChunkKind::service, service});
}

void Recorder::end_commands() {
  if (commands_.empty()) return;
  std::string bytes;
  StateWriter writer(bytes);
  writer(std::exchange(commands_, {}));
  append_chunk(bytes_, {ChunkKind::commands, bytes});
}

void Recorder::flush() {
  end_commands();
  if (!bytes_.empty()) sink_(std::exchange(bytes_, {}));
}

}  // namespace weft::record
