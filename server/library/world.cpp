#include "weft/world.h"

#include <algorithm>

#include "cloth/core/subnormals.h"
#include "cloth/guard/guard_event.h"
#include "cloth/world/state_hash.h"
#include "library/checks.h"
#include "library/parameters.h"
#include "library/world_impl.h"

namespace weft {
namespace {

using library::within;

scene::Scene sound_scene(scene::Result result, const std::string& name) {
  if (auto* scene = std::get_if<scene::Scene>(&result)) return std::move(*scene);
  std::string text = name;
  std::vector<SceneError::Problem> problems;
  for (const scene::Problem& problem : std::get<std::vector<scene::Problem>>(result)) {
    text.append(text.empty() ? "" : "\n").append(problem.text());
    problems.push_back({problem.path, problem.message});
  }
  throw SceneError(text, std::move(problems));
}

}  // namespace

World::Impl::Impl(scene::Scene described)
    : scene(std::move(described)),
      simulation(scene.simulation),
      effects(scene.simulation.effects),
      packed(scene.simulation.cloths.size()) {}

const weft::Ball& World::Impl::ball(std::uint32_t id) const {
  const weft::Ball* found = simulation.colliders().find(id);
  if (found == nullptr) throw Error("ball " + std::to_string(id) + " is no longer there");
  return *found;
}

void World::Impl::compose() {
  std::vector<EffectDescription> on;
  std::copy_if(effects.begin(), effects.end(), std::back_inserter(on), [&](const EffectDescription& effect) {
    return std::find(effects_off.begin(), effects_off.end(), name_of(effect)) == effects_off.end();
  });
  simulation.set_effects(on);
}

void World::Impl::begin_anew() {
  effects = scene.simulation.effects;
  effects_off.clear();
  seen_levels.clear();
  simulation.reset();
}

std::span<const float> World::Impl::pack(std::size_t cloth, const VectorField<float>& field,
                                         const Vec3& offset) {
  const Grid& grid = field.grid();
  std::vector<float>& values = packed[cloth];
  values.clear();
  values.reserve(3 * static_cast<std::size_t>(grid.nodes()));
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      values.push_back(static_cast<float>(offset.x() + double(field.x.at(r, c))));
      values.push_back(static_cast<float>(offset.y() + double(field.y.at(r, c))));
      values.push_back(static_cast<float>(offset.z() + double(field.z.at(r, c))));
    }
  }
  return values;
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

std::vector<std::string> World::presets() {
  std::vector<std::string> names;
  for (const scene::Preset& preset : scene::presets()) names.emplace_back(preset.name);
  return names;
}

World World::load(const std::string& preset_or_file, const std::vector<std::string>& overrides) {
  return World(std::make_unique<Impl>(sound_scene(scene::load(preset_or_file, overrides), preset_or_file)));
}

World World::parse(std::string_view document, const std::string& folder) {
  auto result =
      folder.empty() ? scene::parse(document, "scene") : scene::parse_beside(document, "scene", folder);
  return World(std::make_unique<Impl>(sound_scene(std::move(result), "")));
}

void World::step(int count) {
  within(count, "count", library::kSteps);
  const FlushedSubnormals flushed;
  for (int i = 0; i < count; ++i) impl_->simulation.step();
}

double World::time_step() const { return impl_->scene.simulation.time_step; }
double World::time() const { return impl_->simulation.time(); }
void World::reset() { impl_->begin_anew(); }

void World::use_threads(int count) {
  within(count, "count", library::kThreads);
  impl_->threads.reset();
  impl_->threads.emplace(count);
}

std::vector<World::Cloth> World::cloths() const {
  std::vector<Cloth> all;
  for (std::size_t i = 0; i < impl_->simulation.cloths().size(); ++i) all.push_back(Cloth(*impl_, i));
  return all;
}

World::Cloth World::cloth(std::string_view name) const {
  std::vector<std::string> names;
  for (const Cloth& each : cloths()) {
    if (each.name() == name) return each;
    names.push_back(each.name());
  }
  library::refuse_name("name", name, names);
}

std::vector<World::Ball> World::balls() const {
  std::vector<Ball> all;
  for (const weft::Ball& each : impl_->simulation.colliders().balls()) all.push_back(Ball(*impl_, each.id));
  return all;
}

World::Ball World::add_ball(const NewBall& ball) {
  BallDescription made;
  made.position = within(ball.position, "position", library::kPlace);
  made.radius = within(ball.radius, "radius", library::kRadius);
  made.velocity = within(ball.velocity, "velocity", library::kSpeed);
  made.friction = within(ball.friction, "friction", library::kFriction);
  if (ball.mass) {
    made.motion = BallDescription::Motion::dynamic;
    made.mass = within(*ball.mass, "mass", library::kMass);
  }
  return {*impl_, impl_->simulation.add_ball(made)};
}

std::vector<World::Obstacle> World::obstacles() const {
  std::vector<Obstacle> all;
  for (std::size_t i = 0; i < impl_->simulation.colliders().obstacles().size(); ++i) {
    all.push_back(Obstacle(*impl_, i));
  }
  return all;
}

void World::look_from(const Vector& eye) {
  const Vec3 from = within(eye, "eye", library::kPlace);
  const LevelPolicy& policy = impl_->scene.simulation.level_policy;
  const bool first = impl_->seen_levels.empty();
  impl_->seen_levels.resize(impl_->simulation.cloths().size());
  for (std::size_t i = 0; i < impl_->seen_levels.size(); ++i) {
    int& level = impl_->seen_levels[i];
    const double distance = (from - impl_->simulation.centre(i)).norm();
    level = first ? policy.level_at(distance) : policy.level_at(distance, level);
    impl_->simulation.request_level(i, level);
  }
}

void World::set_wind(const Vector& velocity) {
  if (std::none_of(impl_->effects.begin(), impl_->effects.end(), feels_wind)) {
    throw Error("no effect of the scene feels wind");
  }
  const Vec3 wanted{velocity[0], velocity[1], velocity[2]};
  Wind wind = impl_->simulation.wind();
  wind.speed = within(wanted.norm(), "the velocity's size", library::kWindSpeed);
  if (wind.speed > 0) wind.direction = wanted / wind.speed;
  impl_->simulation.set_wind(wind);
}

void World::set_wind_zone(std::size_t zone, const Vector& velocity) {
  const std::size_t zones = impl_->simulation.wind().zones.size();
  if (zone >= zones) {
    throw Error("zone is " + std::to_string(zone) + "; the wind has " + std::to_string(zones) +
                " zones, counted from 0");
  }
  impl_->simulation.set_wind_zone(zone, within(velocity, "velocity", library::kAirSpeed));
}

std::vector<std::string> World::effects() const {
  std::vector<std::string> on;
  for (const EffectDescription& effect : impl_->effects) {
    const std::string name = name_of(effect);
    const auto& off = impl_->effects_off;
    if (std::find(off.begin(), off.end(), name) == off.end()) on.push_back(name);
  }
  return on;
}

void World::set_effect(std::string_view effect, bool on) {
  library::check_effect(impl_->effects, effect);
  std::vector<std::string>& off = impl_->effects_off;
  const auto found = std::find(off.begin(), off.end(), effect);
  if (on == (found == off.end())) return;
  if (on) {
    off.erase(found);
  } else {
    off.emplace_back(effect);
  }
  impl_->compose();
}

void World::set_parameter(std::string_view effect, std::string_view parameter,
                          const std::vector<double>& values) {
  library::set_effect_parameter(impl_->effects, effect, parameter, values);
  impl_->compose();
}

std::vector<std::string> World::events() const {
  std::vector<std::string> lines;
  for (const GuardEvent& event : impl_->simulation.guard_events()) {
    lines.push_back(describe(event, impl_->scene.simulation.cloths[event.cloth].name));
  }
  return lines;
}

std::uint64_t World::hash() const { return state_hash(impl_->simulation); }

}  // namespace weft
