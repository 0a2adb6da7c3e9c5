#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/mesh_writer.h"
#include "cli/problems.h"
#include "cli/progress.h"
#include "cli/stats_writer.h"
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
  std::string stats;
  bool hash = false;
  Threads threads;
};

MeshFrame mesh_of(const Simulation<float>& simulation, std::size_t cloth, int frame) {
  const Particles<float>& particles = simulation.cloths()[cloth].particles();
  const Grid& grid = particles.grid();
  MeshFrame mesh{frame, simulation.time(), grid.rows, grid.cols, {}, {}};
  mesh.positions.reserve(static_cast<std::size_t>(grid.nodes()) * 3);
  mesh.velocities.reserve(static_cast<std::size_t>(grid.nodes()) * 3);
  const auto append = [](std::vector<float>& values, const VectorField<float>& field, int r, int c) {
    values.insert(values.end(), {field.x.at(r, c), field.y.at(r, c), field.z.at(r, c)});
  };
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      append(mesh.positions, particles.position, r, c);
      append(mesh.velocities, particles.velocity, r, c);
    }
  }
  mesh.place = {particles.place.x(), particles.place.y(), particles.place.z()};
  const Cloth<float>& torn = simulation.cloths()[cloth];
  if (torn.walls() != nullptr) mesh.torn_faces = torn.walls()->at(torn.level()).torn_faces();
  return mesh;
}

/// All files of a run: for each cloth one writer per --out, and the stats.
class Outputs {
 public:
  Outputs(const RunOptions& options, const SimulationDescription& description) {
    const bool several = description.cloths.size() > 1;
    for (const ClothDescription& cloth : description.cloths) {
      auto& writers = writers_.emplace_back();
      for (const std::string& path : options.outputs) {
        writers.push_back(MeshWriter::open(several ? MeshWriter::path_for_cloth(path, cloth.name) : path));
        const int written = options.frames + 1;  // and the start
        if (written > writers.back()->max_frames()) {
          throw std::runtime_error(path + ": holds at most " + std::to_string(writers.back()->max_frames()) +
                                   " frames; this run has " + std::to_string(written));
        }
      }
    }
    if (!options.stats.empty()) stats_ = std::make_unique<StatsWriter>(options.stats, several);
  }

  void write(int frame, const Simulation<float>& simulation) {
    for (std::size_t cloth = 0; cloth < writers_.size(); ++cloth) {
      if (writers_[cloth].empty()) continue;
      const MeshFrame mesh = mesh_of(simulation, cloth, frame);
      for (auto& writer : writers_[cloth]) writer->write(mesh);
    }
    if (stats_) stats_->write(frame, simulation);
  }
  void finish() {
    for (auto& writers : writers_) {
      for (auto& writer : writers) writer->finish();
    }
    if (stats_) stats_->finish();
  }

 private:
  std::vector<std::vector<std::unique_ptr<MeshWriter>>> writers_;
  std::unique_ptr<StatsWriter> stats_;
};

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
  choose_levels(options, scene, simulation);
  Outputs outputs(options, scene.simulation);
  outputs.write(0, simulation);

  double seconds = 0, longest = 0;  // of the steps alone
  int longest_frame = 0;
  host::GuardLog guard;
  {
    Progress progress(scene.name, options.frames);
    for (int frame = 1; frame <= options.frames; ++frame) {
      const auto start = Clock::now();
      simulation.step();
      const double step = std::chrono::duration<double>(Clock::now() - start).count();
      seconds += step;
      if (step > longest) {
        longest = step;
        longest_frame = frame;
      }
      for (const host::GuardLog::Notice& notice : guard.stepped(simulation))
        progress.print("weft: " + notice.message);
      outputs.write(frame, simulation);
      progress.show(frame);
    }
  }
  outputs.finish();
  if (const auto counts = guard.stats_json(); !counts.is_null())
    std::fprintf(stderr, "weft: %s: step guard: %s\n", scene.name.c_str(), counts.dump().c_str());
  std::printf("%s: %d frames, %g s simulated in %.2f s, %.3f ms a frame, longest %.3f ms (frame %d)\n",
              scene.name.c_str(), options.frames, simulation.time(), seconds,
              options.frames ? 1e3 * seconds / options.frames : 0.0, 1e3 * longest, longest_frame);
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const ClothReport report = simulation.report(i);
    const Grid& grid = simulation.cloths()[i].particles().grid();
    std::printf(
        "%s: level %d, %d x %d nodes, %d substeps a frame, stretched by %.2g %% and compressed by %.2g %% at "
        "most\n",
        simulation.cloths()[i].description().name.c_str(), report.level, grid.cols, grid.rows,
        report.substeps, 100 * report.strain.max, 100 * report.strain.max_compression);
  }
  if (options.hash) std::printf("%016" PRIx64 "\n", state_hash(simulation));
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
      ->add_option(
          "--out", options->outputs,
          "Meshes, by extension: .obj (one file a frame), .pc2, .csv, .glb; may be given several times")
      ->allow_extra_args(false);
  command->add_option("--stats", options->stats, "Figures for each frame, as CSV");
  command->add_flag("--hash", options->hash,
                    "A hash of all bits of the last state, alone on the last line of standard output");
  options->threads.add_to(*command);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace weft::cli
