#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/problems.h"
#include "cli/progress.h"
#include "cli/run/kept_state.h"
#include "cli/run/outputs.h"
#include "cli/run/summary.h"
#include "cli/threads.h"
#include "cloth/core/clock.h"
#include "cloth/core/subnormals.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "host/guard_log.h"
#include "scene/scene.h"

namespace weft::cli {
namespace {

struct RunOptions {
  std::string scene;
  int frames = 600;
  std::vector<std::string> overrides;
  std::optional<double> distance;
  std::optional<int> level;
  std::vector<std::string> outputs;
  std::string stats, from, save;
  bool hash = false, json = false;
  Threads threads;
};

/// Frames count on where a run goes on from another.
int frame_of(const Simulation<float>& simulation) { return static_cast<int>(simulation.step_count()); }

/// Every cloth at the level asked for, from the first frame on: the level itself, or what the distance
/// deserves.
void choose_levels(const RunOptions& options, const scene::Scene& scene, Simulation<float>& simulation) {
  const double distance = options.distance.value_or(scene.camera_distance);
  const int level = options.level.value_or(simulation.description().level_policy.level_at(distance));
  for (Cloth<float>& cloth : simulation.cloths()) {
    cloth.request_level(level);
    cloth.apply_pending_level();
    if (cloth.level() != level) {
      std::fprintf(stderr, "weft: %s is at level %d, the nearest to %d that it has\n",
                   cloth.description().name.c_str(), cloth.level(), level);
    }
  }
}

/// Makes the steps, each of which is written.
StepTimes make_steps(Simulation<float>& simulation, int steps, const std::string& scene, RunOutputs& outputs,
                     host::GuardLog& guard) {
  StepTimes times{simulation.description().time_step};
  Progress progress(scene, steps);
  for (int step = 1; step <= steps; ++step) {
    const auto start = Clock::now();
    simulation.step();
    const int frame = frame_of(simulation);
    times.add(frame, std::chrono::duration<double>(Clock::now() - start).count());
    for (const host::GuardLog::Notice& notice : guard.stepped(simulation))
      progress.print("weft: " + notice.message);
    outputs.write(frame, simulation);
    progress.show(step);
  }
  return times;
}

int run(const RunOptions& options) {
  scene::Result result = scene::load(options.scene, options.overrides);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
    print_problems(options.scene, *problems);
    return kBadUsage;
  }
  const auto& scene = std::get<scene::Scene>(result);
  const ThreadLimit limit = options.threads.limit();
  flush_subnormals();  // as where scenes are served: the bits must be the same
  Simulation<float> simulation(scene.simulation);
  if (!options.from.empty()) go_on_from(options.from, scene, simulation);
  if (options.from.empty() || options.level || options.distance) choose_levels(options, scene, simulation);
  // Before the steps, so that who cannot write learns it now.
  std::optional<OutputFile> saved;
  if (!options.save.empty()) saved.emplace(options.save);
  RunOutputs outputs(options.outputs, options.stats, options.frames + 1, scene, simulation);
  outputs.write(frame_of(simulation), simulation);

  host::GuardLog guard;
  const StepTimes times = make_steps(simulation, options.frames, scene.name, outputs, guard);
  outputs.finish();
  if (saved) keep_state(*saved, scene, simulation);
  if (const auto counts = guard.stats_json(); !counts.is_null())
    std::fprintf(stderr, "weft: %s: step guard: %s\n", scene.name.c_str(), counts.dump().c_str());
  RunSummary summary{scene.name, simulation, times, guard, std::nullopt, outputs.files()};
  if (saved) summary.files.push_back(options.save);
  if (options.hash) summary.hash = state_hash(simulation);
  const std::string told = options.json ? summary.json().dump(2) + '\n' : summary.text();
  std::fwrite(told.data(), 1, told.size(), stdout);
  const auto& cloths = simulation.cloths();
  const bool frozen =
      std::any_of(cloths.begin(), cloths.end(), [](const Cloth<float>& cloth) { return cloth.frozen(); });
  return frozen ? kBadState : 0;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Simulates a scene without a window, as fast as it goes");
  command->add_option("SCENE", options->scene, "A preset's name (weft check --list) or a scene file")
      ->required();
  command
      ->add_option("--frames", options->frames,
                   "Steps to simulate; outputs hold the start as frame 0 besides")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--set", options->overrides,
                   "POINTER=VALUE changes a value of the scene, as /wind/speed=8")
      ->allow_extra_args(false);
  auto* distance = command
                       ->add_option("--distance", options->distance,
                                    "A viewer's distance from the cloths, m (default: the scene's camera)")
                       ->check(CLI::Range(0.0, 1e6));
  command
      ->add_option("--level", options->level, "The cloths' level, whatever the distance; 6 has 64 x 64 cells")
      ->check(CLI::Range(kMinLevel, kMaxLevel))
      ->excludes(distance);
  command
      ->add_option("--out", options->outputs,
                   "Meshes, by extension: .glb, .usda, .obj (one file a frame) with balls and obstacles; "
                   ".pc2, .mdd and .csv, "
                   "one a cloth; may be given several times")
      ->allow_extra_args(false);
  command->add_option("--stats", options->stats, "Figures for each frame, as CSV");
  command->add_flag("--hash", options->hash,
                    "A hash of all bits of the last state, alone on the last line of standard output");
  command->add_flag("--json", options->json, "Tells the summary as JSON, with the hash if asked for");
  command->add_option("--save", options->save, "File for the last state, for --from");
  command
      ->add_option(
          "--from", options->from,
          "Goes on from a state that --save wrote of the same scene, or from a recording's end, at the "
          "levels that it has there, to the same bits as without the break")
      ->check(CLI::ExistingFile);
  options->threads.add_to(*command);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace weft::cli
