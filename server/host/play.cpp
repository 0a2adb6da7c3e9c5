/// LiveScene that shows a recording: its steps, and what viewers are told of what was commanded in it.
#include <algorithm>
#include <set>
#include <utility>

#include "host/live_scene.h"
#include "host/refusal.h"
#include "host/scene_messages.h"
#include "host/tuning.h"

namespace weft::host {
namespace {

using nlohmann::json;

/// Commands that concern the viewer alone, or when the recording is shown.
template <class Command>
constexpr bool kWatches =
    std::is_same_v<Command, protocol::SeatResume> || std::is_same_v<Command, protocol::Camera> ||
    std::is_same_v<Command, protocol::Pause> || std::is_same_v<Command, protocol::Resume> ||
    std::is_same_v<Command, protocol::Reset> || std::is_same_v<Command, protocol::Step>;

/// Motion by id, so that balls that come, go and are thrown are told.
json motions_json(const Colliders& colliders) {
  json motions = json::object();
  for (const Ball& ball : colliders.balls()) motions[std::to_string(ball.id)] = ball.flies();
  return motions;
}

/// Calls changed(key) for each member of one or both that differs.
template <class Changed>
void for_each_difference(const json& before, const json& now, const Changed& changed) {
  std::set<std::string> keys;
  for (const json* each : {&before, &now}) {
    for (const auto& item : each->items()) keys.insert(item.key());
  }
  for (const std::string& key : keys) {
    if (before.value(key, json()) != now.value(key, json())) changed(key);
  }
}

}  // namespace

std::optional<protocol::Error> LiveScene::fixed_by_recording(const SceneCommand& command) const {
  const bool watches =
      std::visit([](const auto& each) { return kWatches<std::decay_t<decltype(each)>>; }, command);
  if (watches || !plays()) return std::nullopt;
  return refused(
      "unavailable", "/op",
      "a recording is shown: it can be watched, paused, stepped and begun anew (reset), not changed");
}

void LiveScene::play_step() {
  const record::Replay& replay = *recorded_.replay();
  const std::uint64_t commands = replay.commands(), step = simulation_.step_count();
  recorded_.step();
  tell_guard_events();
  takes_effect_ = simulation_.step_count() + 1;
  if (replay.commands() != commands) {
    composition_.follow(simulation_);
    if (simulation_.step_count() <= step) begun_anew();  // it was reset after the step
    follow_played();
  }
  if (replay.divergence() && !std::exchange(divergence_warned_, true))
    warnings_.emplace_back("what is shown is not what was recorded, as of another version of Weft");
  if (!replay.at_end()) return;
  if (recorded_.loops()) {
    recorded_.run(command::Reset{});
    composition_.follow(simulation_);
    begun_anew();
  } else {
    waiting_steps_ = 0;
    set_paused(true);
  }
}

json LiveScene::told() const {
  json frictions = frictions_json(simulation_.colliders());
  for (const Ball& ball : simulation_.colliders().balls()) frictions.push_back(ball.friction);
  json off = json::object();
  for (const std::string& effect : composition_.effects_off()) off[effect] = true;
  return {{"wind", wind_json(simulation_.wind())},
          {"balls", motions_json(simulation_.colliders())},
          {"frictions", std::move(frictions)},
          {"pins", pins_json(simulation_.cloths())},
          {"materials", materials_json(composition_.materials(), composition_.effects())},
          {"off", std::move(off)},
          {"parameters", parameters_json(composition_.effects())}};
}

void LiveScene::follow_played() {
  const json before = std::exchange(told_, told());
  const auto differs = [&](const char* what) { return before[what] != told_[what]; };
  if (differs("wind")) wind_changed();
  if (differs("frictions")) frictions_changed();
  for_each_difference(before["balls"], told_["balls"], [&](const std::string& id) {
    const bool was = before["balls"].contains(id), is = told_["balls"].contains(id);
    const char* kind = was && is ? "ball.throw" : is ? "ball.add" : "ball.remove";
    balls_changed(kind, takes_effect_, static_cast<BallId>(std::stoul(id)));
  });
  for_each_difference(before["off"], told_["off"], [&](const std::string& effect) { effect_set(effect); });
  for_each_difference(before["parameters"], told_["parameters"],
                      [&](const std::string& effect) { effect_tuned(effect); });
  for (std::size_t i = 0; i < composition_.materials().size(); ++i) {
    if (before["pins"][i].size() > told_["pins"][i].size()) {
      pins_changed("cloth.unpin", i);
    } else if (before["pins"][i] != told_["pins"][i]) {
      pins_changed("cloth.pin", i);
    }
    if (before["materials"][i] != told_["materials"][i]) cloth_tuned(i);
  }
}

}  // namespace weft::host
