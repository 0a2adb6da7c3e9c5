#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/problems.h"
#include "scene/scene.h"

namespace weft::cli {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool list = false;
};

const char* name_of(const EffectDescription& effect) {
  return std::visit([](const auto& each) { return std::decay_t<decltype(each)>::kName; }, effect);
}

void print_summary(const scene::Scene& scene) {
  const SimulationDescription& simulation = scene.simulation;
  std::printf("%s: ok\n  title: %s\n", scene.name.c_str(), scene.title.c_str());
  for (const std::string& note : scene.notes) std::printf("  note: %s\n", note.c_str());
  for (const ClothDescription& cloth : simulation.cloths) {
    const Grid grid = cloth.base_cells.at(cloth.max_level);
    std::printf("  cloth %s: %g x %g m, %g kg/m2, levels %d to %d, at most %d x %d nodes, %zu pins\n",
                cloth.name.c_str(), cloth.size.x(), cloth.size.y(), cloth.material.density, cloth.min_level,
                cloth.max_level, grid.cols, grid.rows, cloth.pins.size());
  }
  for (const BallDescription& ball : simulation.balls) {
    std::printf("  ball: radius %g m, %s\n", ball.radius,
                ball.motion == BallDescription::Motion::dynamic ? "dynamic" : "kinematic");
  }
  std::printf("  effects:");
  for (const EffectDescription& effect : simulation.effects) std::printf(" %s", name_of(effect));
  std::printf("%s\n  time step: %g s\n", simulation.effects.empty() ? " none" : "", simulation.time_step);
}

/// Name and title of every preset; the titles come from the scene files themselves.
int list_presets() {
  int exit_code = 0;
  for (const scene::Preset& preset : scene::presets()) {
    const scene::Result result = scene::parse(preset.text, preset.name);
    if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
      print_problems(std::string(preset.name), *problems);
      exit_code = kFailed;
      continue;
    }
    const auto& scene = std::get<scene::Scene>(result);
    std::printf("%-20s %s\n", scene.name.c_str(), scene.title.c_str());
  }
  return exit_code;
}

int check(const CheckOptions& options) {
  if (options.list) return list_presets();
  const scene::Result result = scene::load(options.scene, options.overrides);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
    print_problems(options.scene, *problems);
    return kFailed;
  }
  print_summary(std::get<scene::Scene>(result));
  return 0;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Checks a scene and lists everything that is wrong with it");
  auto* scene = command->add_option("SCENE", options->scene, "A preset's name or a scene file");
  command
      ->add_option("--set", options->overrides, "POINTER=VALUE changes a value of the scene before the check")
      ->allow_extra_args(false);
  auto* list = command->add_flag("--list", options->list, "Lists the preset scenes")->excludes(scene);
  command->callback([=, &exit_code] {
    if (scene->count() + list->count() == 0) throw CLI::RequiredError("SCENE or --list");
    exit_code = check(*options);
  });
}

}  // namespace weft::cli
