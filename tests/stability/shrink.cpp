#include <algorithm>
#include <stdexcept>

#include "random_scenes.h"
#include "scene_json.h"

namespace weft::stability {
namespace {

using Scenes = std::vector<SimulationDescription>;

/// `scene` with `change` made to a copy.
template <class Change>
void with(Scenes& simpler, const SimulationDescription& scene, Change change) {
  change(simpler.emplace_back(scene));
}

/// Each with one thing fewer, the largest first.
Scenes simpler_than(const SimulationDescription& scene) {
  Scenes simpler;
  const auto without = [&](auto member) {
    for (std::size_t i = 0; i < (scene.*member).size(); ++i) {
      with(simpler, scene,
           [&](auto& s) { (s.*member).erase((s.*member).begin() + static_cast<std::ptrdiff_t>(i)); });
    }
  };
  if (scene.cloths.size() > 1) with(simpler, scene, [](auto& s) { s.cloths.pop_back(); });
  without(&SimulationDescription::balls);
  without(&SimulationDescription::obstacles);
  without(&SimulationDescription::effects);
  const auto cloth = [&](auto change) { with(simpler, scene, [&](auto& s) { change(s.cloths[0]); }); };
  for (std::size_t i = 0; i < scene.cloths[0].pins.size(); ++i) {
    cloth([&](auto& c) { c.pins.erase(c.pins.begin() + static_cast<std::ptrdiff_t>(i)); });
  }
  const ClothDescription plain;
  cloth([](auto& c) { c.max_level = c.initial_level = c.min_level; });
  cloth([](auto& c) { c.min_level = c.initial_level = c.max_level; });
  cloth([](auto& c) { c.initial_level = c.min_level; });
  cloth([&](auto& c) { c.velocity = plain.velocity; });
  cloth([&](auto& c) { c.perturbation = plain.perturbation; });
  cloth([&](auto& c) { c.orientation = plain.orientation; });
  cloth([&](auto& c) { c.base_cells = plain.base_cells; });
  cloth([&](auto& c) { c.discretization = plain.discretization; });
  cloth([](auto& c) { c.sewn = false; });
  cloth([&](auto& c) { c.size = plain.size; });
  cloth([&](auto& c) { c.size.y() = c.size.x(); });
  for (double Material::*constant :
       {&Material::density, &Material::shear, &Material::bending, &Material::damping}) {
    cloth([&](auto& c) { c.material.*constant = plain.material.*constant; });
  }
  cloth([&](auto& c) { c.material.structural = plain.material.structural; });
  cloth([&](auto& c) { c.material.structural = c.material.structural.warp; });
  cloth([&](auto& c) { c.material.rigidity = plain.material.rigidity; });
  cloth([&](auto& c) { c.material.limit = plain.material.limit; });
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    with(simpler, scene, [&](auto& s) { s.obstacles[i].path.clear(); });
    with(simpler, scene, [&](auto& s) { s.obstacles[i].friction = 0; });
    with(simpler, scene, [&](auto& s) { s.obstacles[i].body.reset(); });
  }
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    with(simpler, scene, [&](auto& s) { s.balls[i].path.clear(); });
    with(simpler, scene, [&](auto& s) { s.balls[i].friction = 0; });
    with(simpler, scene, [&](auto& s) { s.balls[i].velocity.setZero(); });
  }
  with(simpler, scene, [](auto& s) { s.wind = Wind{}; });
  with(simpler, scene, [](auto& s) { s.wind.zones.clear(); });
  with(simpler, scene, [](auto& s) { s.wind.gusts = {}; });
  with(simpler, scene, [](auto& s) { s.wind.turbulence = {}; });
  with(simpler, scene, [](auto& s) { s.time_step = 1.0 / 60; });
  with(simpler, scene, [](auto& s) { s.seed = 1; });
  with(simpler, scene, [](auto& s) { s.seed &= ~std::uint64_t{4}; });  // without the hand
  with(simpler, scene, [](auto& s) { s.seed &= ~std::uint64_t{2}; });  // effects stay on
  return simpler;
}

}  // namespace

SimulationDescription shrink(SimulationDescription scene, const Check& check) {
  const std::optional<Failure> whole = check(scene);
  if (!whole) throw std::invalid_argument("only a scene that fails can be shrunk");
  const auto fails_alike = [&](const SimulationDescription& candidate) {
    const std::optional<Failure> failure = check(candidate);
    return failure && failure->kind == whole->kind;
  };
  for (bool smaller = true; smaller;) {
    smaller = false;
    for (SimulationDescription& candidate : simpler_than(scene)) {
      if (scene_json(candidate) == scene_json(scene) || !fails_alike(candidate)) continue;
      scene = std::move(candidate);
      smaller = true;
      break;
    }
  }
  return scene;
}

}  // namespace weft::stability
