#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cloth/world/simulation.h"
#include "host/service_state.h"
#include "protocol/message.h"

namespace weft::host {

/// What a scene's steps are composed of as viewers have changed it: its effects, which of them are on, and
/// its cloths' materials. What was changed is due in the next step, once, however many commands changed it.
class Composition {
 public:
  explicit Composition(const SimulationDescription& scene) { begin_anew(scene); }

  /// As the scene has it.
  void begin_anew(const SimulationDescription& scene);
  /// As a simulation has it that others command.
  void follow(const Simulation<float>& simulation);

  /// The scene's, on and off, with the parameters that they have now.
  const std::vector<EffectDescription>& effects() const { return effects_; }
  /// Of them, by name, each once, in the scene's order.
  const std::vector<std::string>& effects_off() const { return effects_off_; }
  /// The cloths', as they are now.
  const std::vector<Material>& materials() const { return materials_; }
  bool has(std::string_view effect) const;
  bool is_off(std::string_view effect) const;
  /// The description with effects that are on, and materials, as they are now.
  void put_into(SimulationDescription& description) const;

  // Each does nothing where nothing is to be changed, and returns whether something was.

  /// An effect that the scene has.
  bool set(const protocol::EffectSet& command);
  /// Or what is wrong with the command.
  std::variant<bool, protocol::Error> tune(const protocol::EffectTune& command);
  std::variant<bool, protocol::Error> tune(const protocol::ClothTune& command);

  /// What is due in the step that begins; from then on nothing is.
  Recompose take_due() { return std::exchange(due_, Recompose::nothing); }

  /// Its part of what is written down.
  void save(ServiceState& state) const;
  /// Goes on from there. Materials of another number of cloths are left out.
  void load(const ServiceState& state);

 private:
  std::vector<EffectDescription> effects_;
  std::vector<std::string> effects_off_;
  std::vector<Material> materials_;
  Recompose due_ = Recompose::nothing;
};

}  // namespace weft::host
