#include "record/replay.h"

#include "cloth/core/subnormals.h"
#include "cloth/world/state.h"
#include "cloth/world/state_hash.h"

namespace weft::record {

Replay::Replay(const Recording& recording)
    : recording_(recording), simulation_(recording.scene().simulation) {
  do_what_is_due();
}

void Replay::do_what_is_due() {
  const FlushedSubnormals flushed;  // as where scenes are served: the bits must be the same
  const auto& events = recording_.events();
  for (; next_ < events.size(); ++next_) {
    const Event& event = events[next_];
    if (const auto* command = std::get_if<command::Command>(&event)) {
      if (const auto* steps = std::get_if<command::Steps>(command)) {
        if (made_ < steps->count) return;
        made_ = 0;
      } else {
        std::visit([&](const auto& each) { each.carry_out(simulation_); }, *command);
        ++commands_;
        anywhere_ = false;
      }
    } else if (const auto* state = std::get_if<StateThen>(&event)) {
      if (anywhere_) {
        load_state(simulation_, state->bytes);
      } else if (save_state(simulation_) != state->bytes) {
        diverged(0, 0);
        load_state(simulation_, state->bytes);
      }
      anywhere_ = false;
    } else if (const auto* hash = std::get_if<HashThen>(&event)) {
      const std::uint64_t found = state_hash(simulation_);
      if (found == hash->hash) {
        ++hashes_;
      } else {
        diverged(hash->hash, found);
      }
    } else {
      service_ = std::get<ServiceThen>(event).bytes;
    }
  }
}

void Replay::diverged(std::uint64_t recorded, std::uint64_t found) {
  if (!divergence_) divergence_ = Divergence{steps_, recorded, found};
}

bool Replay::step() {
  if (at_end()) return false;
  const FlushedSubnormals flushed;
  simulation_.step();
  anywhere_ = false;
  ++made_;
  ++steps_;
  do_what_is_due();
  return true;
}

void Replay::go_to(std::size_t event, std::uint64_t steps) {
  next_ = event;
  made_ = 0;
  steps_ = steps;
  anywhere_ = true;
  do_what_is_due();
}

void Replay::seek(std::uint64_t steps) {
  const auto& events = recording_.events();
  std::uint64_t at = 0, best_at = 0;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < events.size() && at <= steps; ++i) {
    const auto* command = std::get_if<command::Command>(&events[i]);
    if (const auto* made = command ? std::get_if<command::Steps>(command) : nullptr) at += made->count;
    if (std::holds_alternative<StateThen>(events[i])) {
      best = i;
      best_at = at;
    }
  }
  if (steps < steps_ && !(best && best_at <= steps)) {
    simulation_.reset();
    go_to(0, 0);
  } else if (best && (best_at > steps_ || steps < steps_)) {
    go_to(*best, best_at);
  }
  while (steps_ < steps && step()) {
  }
}

}  // namespace weft::record
