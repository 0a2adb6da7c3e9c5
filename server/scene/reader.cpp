#include <algorithm>
#include <array>
#include <utility>

#include "scene/document.h"
#include "scene/pin_check.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// "notes": one string or several.
std::vector<std::string> read_notes(Object& scene) {
  constexpr std::size_t kMaxNotes = 64, kNoteLength = 2000;
  std::vector<std::string> notes;
  const json* value = scene.find("notes");
  if (value && value->is_string()) {
    scene.string("notes", notes.emplace_back(), kNoteLength);
  } else if (value && !value->is_array()) {
    scene.report().refuse(*value, scene.path("notes"), "a string or an array of strings");
  } else {
    scene.each("notes", 0, kMaxNotes, [&](const json& note, const std::string& path) {
      read_string(note, path, kNoteLength, notes.emplace_back(), scene.report());
    });
  }
  return notes;
}

/// Where people look from: the eye defaults to `distance` in front of the target, the distance to the eye's.
void read_camera(const json& value, const std::string& path, Report& report, Scene& scene) {
  constexpr Range kDistance{0, 1e6, "m"};
  constexpr Range kFar{-1e6, 1e6, "m"};
  Object object(value, path, report);
  object.vector("target", scene.camera_target, kPosition);
  const bool distance = object.number("distance", scene.camera_distance, kDistance);
  if (object.vector("eye", scene.camera_eye, kFar)) {
    if (!distance) scene.camera_distance = (scene.camera_eye - scene.camera_target).norm();
  } else {
    scene.camera_eye = scene.camera_target + Vec3(0, 0, scene.camera_distance);
  }
}

std::vector<ClothDescription> read_cloths(Object& scene, const SceneFolder& folder, MotionFiles& motions,
                                          std::vector<Look>& looks) {
  std::vector<ClothDescription> cloths;
  scene.require("cloths", "an array of cloths");
  scene.each("cloths", 1, kMaxCloths, [&](const json& value, const std::string& path) {
    ClothDescription cloth = read_cloth(value, path, scene.report(), folder, motions, looks.emplace_back());
    const auto same =
        std::find_if(cloths.begin(), cloths.end(), [&](const auto& o) { return o.name == cloth.name; });
    if (same != cloths.end()) {
      scene.report().add(path + "/name", "is \"" + cloth.name + "\", the name of /cloths/" +
                                             std::to_string(same - cloths.begin()) +
                                             " too; names must differ");
    }
    cloths.push_back(std::move(cloth));
  });
  return cloths;
}

std::vector<EffectDescription> read_effects(Object& scene) {
  constexpr std::size_t kMaxEffects = std::variant_size_v<EffectDescription>;
  std::vector<EffectDescription> effects;
  std::array<std::string, kMaxEffects> first_of_type;
  scene.each("effects", 0, kMaxEffects, [&](const json& value, const std::string& path) {
    auto effect = read_effect(value, path, scene.report());
    if (!effect) return;
    std::string& first = first_of_type[effect->index()];
    if (!first.empty()) {
      scene.report().add(path + "/type", "is the type of " + first + " too; an effect may be listed once");
    } else {
      first = path;
    }
    effects.push_back(*effect);
  });
  return effects;
}

/// Layers of cloth would take the nodes of a seam for two that touch, and a torn seam for whole.
void check_sewn(const SimulationDescription& simulation, Report& report) {
  const auto& cloths = simulation.cloths;
  const auto sewn = std::find_if(cloths.begin(), cloths.end(), [](const auto& cloth) { return cloth.sewn; });
  for (std::size_t i = 0; i < simulation.effects.size(); ++i) {
    const EffectDescription& effect = simulation.effects[i];
    const auto* inflation = std::get_if<InflationEffect>(&effect);
    if (sewn == cloths.end()) {
      if (inflation == nullptr || !inflation->volume) continue;
      report.add(element_path("/effects", i) + "/volume", "is given, but no cloth of the scene is sewn");
    } else if (std::holds_alternative<ClothContactEffect>(effect) ||
               std::holds_alternative<TearingEffect>(effect)) {
      report.add(element_path("/effects", i) + "/type",
                 "is \"" + std::visit([](const auto& e) { return std::string(e.kName); }, effect) +
                     "\", which does not go with a cloth that is sewn, as " +
                     element_path("/cloths", static_cast<std::size_t>(sewn - cloths.begin())) + " is");
    }
  }
}

}  // namespace

Result read_scene(const json& document, std::string_view name, const SceneFolder& folder,
                  std::vector<Problem> found, std::map<std::string, std::string> overflows) {
  constexpr std::size_t kTitleLength = 200;
  constexpr Range kTimeStep{1e-6, 0.1, "s"};
  constexpr Range kSleepSpeed{0, 1, "m/s"};
  constexpr Range kSeed{0, 9007199254740991};  // 2^53 - 1: exact in every JSON reader
  Report report(std::move(found), std::move(overflows));
  Scene scene;
  scene.name = name;
  scene.title = name;
  {
    Object object(document, "", report);
    SimulationDescription& simulation = scene.simulation;
    MotionFiles motions(folder);
    object.string("title", scene.title, kTitleLength);
    scene.notes = read_notes(object);
    simulation.cloths = read_cloths(object, folder, motions, scene.looks);
    object.each("colliders", 0, kMaxColliders, [&](const json& value, const std::string& path) {
      read_collider(value, path, report, folder, motions, simulation);
    });
    simulation.effects = read_effects(object);
    check_sewn(simulation, report);
    if (const json* wind = object.find("wind")) {
      simulation.wind = read_wind(*wind, "/wind", report);
      if (std::none_of(simulation.effects.begin(), simulation.effects.end(), feels_wind)) {
        report.add("/wind", "is read by no effect; list \"paper_wind\" or \"aerodynamics\" in /effects");
      }
    }
    if (const json* integrator = object.find("integrator")) {
      simulation.integrator = read_integrator(*integrator, "/integrator", report);
    }
    if (const json* quality = object.find("quality")) {
      scene.quality = read_quality(*quality, "/quality", report);
    }
    object.number("time_step", simulation.time_step, kTimeStep);
    check_pins(simulation, report);
    object.number("sleep_speed", simulation.sleep_speed, kSleepSpeed);
    if (const json* policy = object.find("level_policy")) {
      simulation.level_policy = read_level_policy(*policy, "/level_policy", report);
    }
    object.integer("seed", simulation.seed, kSeed);
    if (const json* camera = object.find("camera")) read_camera(*camera, "/camera", report, scene);
  }
  auto problems = report.take();
  if (!problems.empty()) return problems;
  for (std::string& note : report.take_notes()) scene.notes.push_back(std::move(note));
  return scene;
}

}  // namespace weft::scene
