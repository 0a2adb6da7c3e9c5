#include "host/composition.h"

#include <algorithm>
#include <utility>

#include "host/tuning.h"

namespace weft::host {

using protocol::Error;

void Composition::begin_anew(const SimulationDescription& scene) {
  effects_ = scene.effects;
  effects_off_.clear();
  materials_.clear();
  materials_.reserve(scene.cloths.size());
  for (const ClothDescription& cloth : scene.cloths) materials_.push_back(cloth.material);
  due_ = Recompose::nothing;
}

void Composition::follow(const Simulation<float>& simulation) {
  for (std::size_t i = 0; i < materials_.size(); ++i)
    materials_[i] = simulation.cloths()[i].description().material;
  // Those that are on are in the scene's order.
  effects_off_.clear();
  auto on = simulation.effects().begin();
  for (EffectDescription& effect : effects_) {
    const std::string name = name_of(effect);
    if (on != simulation.effects().end() && name_of(*on) == name) {
      effect = *on++;
    } else if (!is_off(name)) {
      effects_off_.push_back(name);
    }
  }
}

bool Composition::has(std::string_view effect) const {
  return std::any_of(effects_.begin(), effects_.end(),
                     [&](const EffectDescription& each) { return name_of(each) == effect; });
}

bool Composition::is_off(std::string_view effect) const {
  return std::find(effects_off_.begin(), effects_off_.end(), effect) != effects_off_.end();
}

void Composition::put_into(SimulationDescription& description) const {
  description.effects = effects_;
  std::erase_if(description.effects,
                [&](const EffectDescription& effect) { return is_off(name_of(effect)); });
  for (std::size_t i = 0; i < materials_.size(); ++i) description.cloths[i].material = materials_[i];
}

bool Composition::set(const protocol::EffectSet& command) {
  if (is_off(command.effect) == !command.on) return false;
  std::vector<std::string> off;
  for (const EffectDescription& effect : effects_) {
    const std::string name = name_of(effect);
    const bool listed = std::find(off.begin(), off.end(), name) != off.end();
    if (!listed && (name == command.effect ? !command.on : is_off(name))) off.push_back(name);
  }
  effects_off_ = std::move(off);
  due_ = Recompose::effects;
  return true;
}

std::variant<bool, Error> Composition::tune(const protocol::EffectTune& command) {
  const nlohmann::json before = parameters_json(effects_);
  if (auto error = host::tune(command, effects_)) return *std::move(error);
  if (parameters_json(effects_) == before) return false;
  if (!is_off(command.effect)) due_ = Recompose::effects;
  return true;
}

std::variant<bool, Error> Composition::tune(const protocol::ClothTune& command) {
  Material& material = materials_[command.cloth];
  const Material before = material;
  if (auto error = host::tune(command, effects_, material)) return *std::move(error);
  if (material == before) return false;
  due_ = std::max(due_, Recompose::materials);
  return true;
}

void Composition::save(ServiceState& state) const {
  state.effects = effects_;
  state.effects_off = effects_off_;
  state.materials = materials_;
  state.recompose = due_;
}

void Composition::load(const ServiceState& state) {
  effects_ = state.effects;
  effects_off_ = state.effects_off;
  if (state.materials.size() == materials_.size()) materials_ = state.materials;
  due_ = state.recompose;
}

}  // namespace weft::host
