/// LiveScene's commands: what each does, and when it is refused.
#include <algorithm>
#include <utility>

#include "host/effect_tuning.h"
#include "host/live_scene.h"
#include "host/scene_messages.h"

namespace weft::host {
namespace {

using nlohmann::json;
using protocol::Error;

Vec3 to_vec3(const protocol::Vector& v) { return {v[0], v[1], v[2]}; }

Error refused(const char* code, const char* path, std::string message) {
  return {std::nullopt, code, path, std::move(message)};
}

Error no_such_ball(BallId id) {
  return refused("not_found", "/ball", "/ball is " + std::to_string(id) + "; the scene has no such ball");
}

Error no_such_obstacle(std::uint32_t obstacle, std::size_t obstacles) {
  return refused("not_found", "/obstacle",
                 "/obstacle is " + std::to_string(obstacle) + "; the scene has " + std::to_string(obstacles) +
                     " obstacles, counted from 0");
}

Error no_mass(std::uint32_t obstacle) {
  return refused("unavailable", "/obstacle", "/obstacle is " + std::to_string(obstacle) + "; it has no mass");
}

Error no_such_grab(GrabId id) {
  return refused("not_found", "/grab",
                 "/grab is " + std::to_string(id) + "; this viewer holds nothing by that id");
}

bool has_wind(const SimulationDescription& description) {
  return std::any_of(description.effects.begin(), description.effects.end(),
                     [](const EffectDescription& effect) {
                       return std::holds_alternative<PaperWindEffect>(effect) ||
                              std::holds_alternative<AerodynamicsEffect>(effect);
                     });
}

}  // namespace

void LiveScene::apply(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
                      const SceneRequest& request) {
  const auto seat = std::find_if(seats_.begin(), seats_.end(),
                                 [&](const Seat& s) { return s.viewer == viewer && s.visit == visit; });
  if (seat == seats_.end()) return;
  // Most commands are felt in the next step; those that are not say so.
  takes_effect_ = simulation_.step_count() + 1;
  Outcome outcome =
      std::visit([&](const auto& command) { return carry_out(command, *seat); }, request.command);
  if (auto* error = std::get_if<Error>(&outcome)) {
    error->re = request.id;
    viewer->send(make_text(protocol::error_text(*error)));
  } else if (request.id) {
    viewer->send(make_text(protocol::ok_text(*request.id, takes_effect_, std::get<json>(outcome))));
  }
  tell_curve();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Camera& camera, Seat& seat) {
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
  look(seat);
  request_levels();
  if (!wants_step()) seat.wants_frame = true;
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallAdd& add, Seat&) {
  if (simulation_.colliders().balls().size() >= static_cast<std::size_t>(limits_.balls)) {
    return refused("limit", "",
                   "the scene has " + std::to_string(limits_.balls) + " balls, the most allowed");
  }
  BallDescription ball;
  ball.position = to_vec3(add.position);
  ball.radius = add.radius;
  ball.velocity = to_vec3(add.velocity);
  ball.motion = add.motion == protocol::Motion::dynamic ? BallDescription::Motion::dynamic
                                                        : BallDescription::Motion::kinematic;
  ball.mass = add.mass;
  const BallId id = simulation_.add_ball(ball);
  balls_changed("ball.add", id);
  return json{{"ball", id}};
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallMove& move, Seat&) {
  if (!simulation_.move_ball(move.ball, to_vec3(move.position))) return no_such_ball(move.ball);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallThrow& thrown, Seat&) {
  if (!simulation_.throw_ball(thrown.ball, to_vec3(thrown.velocity))) return no_such_ball(thrown.ball);
  balls_changed("ball.throw", thrown.ball);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::BallRemove& remove, Seat&) {
  if (!simulation_.remove_ball(remove.ball)) return no_such_ball(remove.ball);
  balls_changed("ball.remove", remove.ball);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleMove& move, Seat&) {
  const auto& obstacles = simulation_.colliders().obstacles();
  if (move.obstacle >= obstacles.size()) return no_such_obstacle(move.obstacle, obstacles.size());
  Pose pose{to_vec3(move.position), obstacles[move.obstacle].pose.orientation};
  if (move.quaternion) {
    const protocol::Turn& q = *move.quaternion;
    pose.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  }
  simulation_.move_obstacle(move.obstacle, pose);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleThrow& thrown, Seat&) {
  const std::size_t obstacles = simulation_.colliders().obstacles().size();
  if (thrown.obstacle >= obstacles) return no_such_obstacle(thrown.obstacle, obstacles);
  if (!simulation_.throw_obstacle(thrown.obstacle, to_vec3(thrown.velocity), to_vec3(thrown.spin))) {
    return no_mass(thrown.obstacle);
  }
  return json::object();
}

std::optional<Error> LiveScene::too_many_grabs() const {
  std::size_t held = simulation_.colliders().hands().size();
  for (const Cloth<float>& cloth : simulation_.cloths()) held += cloth.grabs().size();
  if (held < static_cast<std::size_t>(limits_.grabs)) return {};
  return refused("limit", "",
                 "the scene is held at " + std::to_string(limits_.grabs) + " points, the most allowed");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ObstacleGrab& grab, Seat& seat) {
  const std::size_t obstacles = simulation_.colliders().obstacles().size();
  if (grab.obstacle >= obstacles) return no_such_obstacle(grab.obstacle, obstacles);
  if (const auto too_many = too_many_grabs()) return *too_many;
  std::optional<Vec3> hand;
  if (grab.position) hand = to_vec3(*grab.position);
  const auto id = simulation_.grab_obstacle(grab.obstacle, to_vec3(grab.point), hand, grab.max_force);
  if (!id) return no_mass(grab.obstacle);
  seat.grabs.push_back(*id);
  return json{{"grab", *id}};
}

std::optional<Error> LiveScene::missing_cloth(std::uint32_t cloth) const {
  const std::size_t cloths = simulation_.cloths().size();
  if (cloth < cloths) return {};
  return refused("not_found", "/cloth",
                 "/cloth is " + std::to_string(cloth) + "; the scene has " + std::to_string(cloths) +
                     " cloths, counted from 0");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothGrab& grab, Seat& seat) {
  if (const auto missing = missing_cloth(grab.cloth)) return *missing;
  if (const auto too_many = too_many_grabs()) return *too_many;
  std::optional<Vec3> hand;
  if (grab.position) hand = to_vec3(*grab.position);
  const GrabId id = simulation_.grab(grab.cloth, {grab.u, grab.v}, hand, grab.max_force);
  seat.grabs.push_back(id);
  return json{{"grab", id}};
}

LiveScene::Outcome LiveScene::carry_out(const protocol::GrabMove& move, Seat& seat) {
  if (std::find(seat.grabs.begin(), seat.grabs.end(), move.grab) == seat.grabs.end()) {
    return no_such_grab(move.grab);
  }
  simulation_.move_grab(move.grab, to_vec3(move.position));
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::GrabRelease& release, Seat& seat) {
  if (std::erase(seat.grabs, release.grab) == 0) return no_such_grab(release.grab);
  simulation_.release(release.grab);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothPin& pin, Seat&) {
  if (const auto missing = missing_cloth(pin.cloth)) return *missing;
  if (simulation_.cloths()[pin.cloth].description().pins.size() >= kMaxPins) {
    return refused("limit", "", "the cloth has " + std::to_string(kMaxPins) + " pins, the most allowed");
  }
  simulation_.pin(pin.cloth, {pin.u, pin.v});
  pins_changed("cloth.pin", pin.cloth);
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::ClothUnpin& unpin, Seat&) {
  if (const auto missing = missing_cloth(unpin.cloth)) return *missing;
  if (!simulation_.unpin(unpin.cloth, {unpin.u, unpin.v})) {
    return refused("not_found", "/cloth", "/cloth is " + std::to_string(unpin.cloth) + "; it has no pins");
  }
  pins_changed("cloth.unpin", unpin.cloth);
  return json::object();
}

std::optional<Error> LiveScene::missing_effect(const std::string& effect) const {
  const auto is_it = [&](const EffectDescription& each) { return name_of(each) == effect; };
  if (std::any_of(effects_.begin(), effects_.end(), is_it)) return {};
  return refused("unavailable", "/effect", "the scene has no effect \"" + effect + "\"");
}

LiveScene::Outcome LiveScene::carry_out(const protocol::EffectSet& set, Seat&) {
  if (const auto missing = missing_effect(set.effect)) return *missing;
  if (is_off(set.effect) == !set.on) return json::object();
  std::vector<std::string> off;  // each once, as the scene lists them
  for (const EffectDescription& effect : effects_) {
    const std::string name = name_of(effect);
    const bool listed = std::find(off.begin(), off.end(), name) != off.end();
    if (!listed && (name == set.effect ? !set.on : is_off(name))) off.push_back(name);
  }
  effects_off_ = std::move(off);
  effects_changed();
  tell_event("effect", takes_effect_,
             {{"effect", set.effect}, {"on", set.on}, {"effects_off", effects_off_}});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::EffectTune& tuning, Seat&) {
  if (const auto missing = missing_effect(tuning.effect)) return *missing;
  const json before = parameters_json(effects_);
  if (const auto error = tune(tuning, effects_)) return *error;
  const json after = parameters_json(effects_);
  if (after == before) return json::object();
  if (!is_off(tuning.effect)) effects_changed();
  tell_event("tune", takes_effect_, {{"effect", tuning.effect}, {"parameters", after[tuning.effect]}});
  return json::object();
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
  simulation_.set_wind(changed);
  tell_event("wind", takes_effect_, {{"wind", wind_json(simulation_.wind())}});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::WindZoneSet& set, Seat&) {
  if (set.zone >= simulation_.wind().zones.size()) {
    return refused("not_found", "/zone",
                   "/zone is " + std::to_string(set.zone) + "; the wind has no such zone");
  }
  simulation_.set_wind_zone(set.zone, to_vec3(set.velocity));
  tell_event("wind", takes_effect_, {{"wind", wind_json(simulation_.wind())}});
  return json::object();
}

LiveScene::Outcome LiveScene::carry_out(const protocol::Quality& quality, Seat&) {
  quality_.wish({quality.max_error, quality.max_ms});
  request_levels();
  tell_event("quality", takes_effect_, {{"wish", quality_.wish_json()}});
  return json::object();
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
  simulation_.reset();
  const json own = parameters_json(scene_.simulation.effects);
  if (!effects_off_.empty() || parameters_json(effects_) != own) {
    effects_ = scene_.simulation.effects;
    effects_off_.clear();
    effects_changed();
  }
  recompose_ = false;  // it is as its description has it
  for (Seat& seat : seats_) seat.grabs.clear();
  quality_.restarted();
  guard_ = {};
  waiting_steps_ = 0;
  ++epoch_;
  takes_effect_ = 0;
  find_bounds();
  for (Seat& seat : seats_) {
    seat.policy_levels.clear();
    seat.steps_unseen.clear();
    look(seat);
  }
  state_changed();
  tell_event("reset", 0,
             {{"epoch", epoch_},
              {"time", 0.0},
              {"paused", paused_},
              {"wind", wind_json(simulation_.wind())},
              {"balls", balls_json(simulation_.colliders())},
              {"parameters", own},
              {"pins", pins_json(simulation_.cloths())}});
  request_levels();
  return json::object();
}

}  // namespace weft::host
