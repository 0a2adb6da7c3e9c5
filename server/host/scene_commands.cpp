/// LiveScene's commands to the scene as a whole: what each does, and when it is refused.
#include <algorithm>
#include <utility>

#include "host/live_scene.h"
#include "host/refusal.h"
#include "host/scene_messages.h"
#include "host/tuning.h"

namespace weft::host {
namespace {

using nlohmann::json;
using protocol::Error;

bool has_wind(const SimulationDescription& description) {
  return std::any_of(description.effects.begin(), description.effects.end(), feels_wind);
}

}  // namespace

std::optional<std::string> LiveScene::apply(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
                                            const SceneRequest& request) {
  const auto seat = std::find_if(seats_.begin(), seats_.end(),
                                 [&](const Seat& s) { return s.viewer == viewer && s.visit == visit; });
  if (seat == seats_.end()) return std::nullopt;
  // Most commands are felt in the next step; those that are not say so.
  takes_effect_ = simulation_.step_count() + 1;
  const auto fixed = fixed_by_recording(request.command);
  Outcome outcome =
      fixed ? Outcome(*fixed)
            : std::visit([&](const auto& command) { return carry_out(command, *seat); }, request.command);
  if (auto* error = std::get_if<Error>(&outcome)) {
    error->re = request.id;
    viewer->send(make_text(protocol::error_text(*error)));
  } else if (request.id) {
    viewer->send(make_text(protocol::ok_text(*request.id, takes_effect_, std::get<json>(outcome))));
  }
  tell_curve();
  const auto* error = std::get_if<Error>(&outcome);
  return error != nullptr ? std::optional(error->code) : std::nullopt;
}

LiveScene::Outcome LiveScene::carry_out(const protocol::SeatResume& resume, Seat& seat) {
  takes_effect_ = simulation_.step_count();
  const auto is_it = [&](const auto& other) { return other.token == resume.seat; };
  // Its old connection may not have been missed yet.
  const auto here = std::find_if(seats_.begin(), seats_.end(), is_it);
  const auto lost = std::find_if(lost_.begin(), lost_.end(), is_it);
  if (here == seats_.end() && lost == lost_.end())
    return refused("not_found", "/seat", "nobody is waited for who had this seat, or it is too late");
  std::vector<GrabId> grabs = std::exchange(here != seats_.end() ? here->grabs : lost->grabs, {});
  if (lost != lost_.end()) lost_.erase(lost);
  seat.grabs.insert(seat.grabs.end(), grabs.begin(), grabs.end());
  return json{{"grabs", seat.grabs}};
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Camera& camera, Seat& seat) {
  seat.placed = true;
  seat.eye.reset();
  seat.cone.reset();
  if (camera.eye) {
    seat.eye = to_vec3(*camera.eye);
  } else {
    seat.distance = *camera.distance;
  }
  if (camera.target) {
    const Vec3 way = to_vec3(*camera.target) - *seat.eye;
    seat.cone = ViewCone{*seat.eye, way.stableNormalized(), *camera.half_angle};
  }
  sight_.look(seat);
  request_levels();
  if (!wants_step()) seat.wants_frame = true;
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothTune& tuning, Seat&) {
  if (const auto missing = missing_cloth(tuning.cloth)) return *missing;
  const auto tuned = composition_.tune(tuning);
  if (const auto* error = std::get_if<Error>(&tuned)) return *error;
  if (!std::get<bool>(tuned)) return json::object();
  study_outdated();
  cloth_tuned(tuning.cloth);
  return json::object();
}

void LiveScene::cloth_tuned(std::size_t cloth) {
  events_.add("cloth.tune", std::to_string(cloth), takes_effect_, [this, cloth] {
    return json{{"cloth", cloth},
                {"material", material_json(composition_.materials()[cloth], composition_.effects())}};
  });
}

std::optional<Error> LiveScene::missing_effect(const std::string& effect) const {
  if (composition_.has(effect)) return {};
  return refused("unavailable", "/effect", "the scene has no effect \"" + effect + "\"");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::EffectSet& set, Seat&) {
  if (const auto missing = missing_effect(set.effect)) return *missing;
  if (!composition_.set(set)) return json::object();
  study_outdated();
  effect_set(set.effect);
  return json::object();
}

void LiveScene::effect_set(const std::string& effect) {
  events_.add("effect", "", takes_effect_, [this, effect] {
    return json{{"effect", effect},
                {"on", !composition_.is_off(effect)},
                {"effects_off", composition_.effects_off()}};
  });
}

LiveScene::Outcome LiveScene::carry_out(const protocol::EffectTune& tuning, Seat&) {
  if (const auto missing = missing_effect(tuning.effect)) return *missing;
  const auto tuned = composition_.tune(tuning);
  if (const auto* error = std::get_if<Error>(&tuned)) return *error;
  if (!std::get<bool>(tuned)) return json::object();
  if (!composition_.is_off(tuning.effect)) study_outdated();
  effect_tuned(tuning.effect);
  return json::object();
}

void LiveScene::effect_tuned(const std::string& effect) {
  events_.add("tune", effect, takes_effect_, [this, effect] {
    return json{{"effect", effect}, {"parameters", parameters_json(composition_.effects())[effect]}};
  });
}

void LiveScene::wind_changed() {
  events_.add("wind", "", takes_effect_, [this] { return json{{"wind", wind_json(simulation_.wind())}}; });
}

LiveScene::Outcome LiveScene::carry_out(const protocol::WindSet& wind, Seat&) {
  if (!has_wind(scene_.simulation)) {
    return refused("unavailable", "", "the scene has no wind effect (paper_wind or aerodynamics)");
  }
  Wind changed = simulation_.wind();
  changed.direction = to_vec3(wind.direction);
  changed.speed = wind.speed;
  if (wind.gusts) changed.gusts.intensity = *wind.gusts;
  if (wind.turbulence) changed.turbulence.intensity = *wind.turbulence;
  if (wind.time_scale) changed.gusts.time_scale = *wind.time_scale;
  if (wind.length_scale) changed.turbulence.length_scale = *wind.length_scale;
  recorded_.run(command::SetWind{changed});
  wind_changed();
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::WindZoneSet& set, Seat&) {
  if (set.zone >= simulation_.wind().zones.size()) {
    return refused("not_found", "/zone",
                   "/zone is " + std::to_string(set.zone) + "; the wind has no such zone");
  }
  recorded_.run(command::SetWindZone{set.zone, to_vec3(set.velocity)});
  wind_changed();
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Quality& quality, Seat&) {
  quality_.wish({quality.max_error, quality.max_ms});
  request_levels();
  events_.add("quality", "", takes_effect_, [this] { return json{{"wish", quality_.wish_json()}}; });
  const json quality_now = quality_.stats_json();
  return quality_now.is_null() ? json::object() : json({{"quality", quality_now}});
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Cost&, Seat& seat) {
  takes_effect_ = simulation_.step_count();
  quality_.ask();
  seat.wants_curve = true;
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Pause&, Seat&) {
  takes_effect_ = simulation_.step_count();
  waiting_steps_ = 0;
  set_paused(true);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Resume&, Seat&) {
  waiting_steps_ = 0;
  set_paused(false);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Step& step, Seat&) {
  if (!paused_) return refused("conflict", "", "step is only for a paused scene");
  if (waiting_steps_ + step.count > kMaxWaitingSteps) {
    return refused(
        "limit", "/count",
        std::to_string(waiting_steps_) + " steps wait already; at most " + std::to_string(kMaxWaitingSteps));
  }
  waiting_steps_ += step.count;
  // When the scene stands still again, so that a script knows which frame to wait for.
  takes_effect_ = simulation_.step_count() + static_cast<std::uint64_t>(waiting_steps_);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Reset&, Seat&) {
  waiting_steps_ = 0;
  const json before = studied_json();
  recorded_.run(command::Reset{});
  composition_.begin_anew(scene_.simulation);
  if (plays()) composition_.follow(simulation_);
  if (studied_json() != before) study_outdated();
  begun_anew();
  return json{{"epoch", epoch_}};
}

void LiveScene::begun_anew() {
  for (Seat& seat : seats_) {
    seat.grabs.clear();
    seat.puts_again_at = 0;
  }
  lost_.clear();
  put_bodies_.begin_anew();
  quality_.restarted();
  guard_ = {};
  ++epoch_;
  takes_effect_ = simulation_.step_count();
  sight_.find_bounds(simulation_.cloths());
  for (Seat& seat : seats_) sight_.look_anew(seat);
  state_changed();
  events_.add("reset", "", takes_effect_, [this] {
    return json{{"epoch", epoch_},
                {"time", simulation_.time()},
                {"paused", paused_},
                {"wind", wind_json(simulation_.wind())},
                {"balls", balls_json(simulation_.colliders())},
                {"parameters", parameters_json(composition_.effects())},
                {"materials", materials_json(composition_.materials(), composition_.effects())},
                {"frictions", frictions_json(simulation_.colliders())},
                {"pins", pins_json(simulation_.cloths())}};
  });
  if (plays()) {
    told_ = told();
    // A reset has all effects on, but a recording may begin where some are off.
    for (const std::string& effect : composition_.effects_off()) effect_set(effect);
  }
  request_levels();
}

}  // namespace weft::host
