/// Weft beside Bullet's soft body and the paper's method, in one run on one thread: Markdown tables of time,
/// strain and motion, then what must be shown and whether it holds.
///   bench_engines [--scene H|B|W]... [--nodes N,N...] [--budget SECONDS] [--quick]
/// --quick: scene H, 33 and 65 nodes a side, no run longer than 20 s.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include "cloth/core/parallel.h"
#include "engines/requirement.h"

namespace weft::bench {
namespace {

struct Options {
  std::string scenes = "HBW";
  std::vector<int> levels{4, 5, 6, 7, 8};
  double budget = 40;  ///< CPU seconds a run
};

constexpr const char* kUsage =
    "usage: bench_engines [--scene H|B|W]... [--nodes N,N...] [--budget SECONDS] [--quick], N among 9, 17, "
    "33, "
    "65, 129, 257\n";

/// The level of so many nodes a side, or none.
std::optional<int> level_of(const std::string& nodes) {
  for (int level = kMinLevel; level <= kMaxLevel; ++level) {
    if (nodes == std::to_string((1 << level) + 1)) return level;
  }
  return {};
}

std::optional<Options> parse(const std::vector<std::string>& arguments) {
  Options options;
  std::string scenes;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string value = i + 1 < arguments.size() ? arguments[i + 1] : std::string();
    if (arguments[i] == "--quick") {
      options.scenes.assign(1, 'H');
      options.levels = {5, 6};
      options.budget = 20;
      continue;
    }
    if (arguments[i] == "--scene" && (value == "H" || value == "B" || value == "W")) {
      scenes += value;
    } else if (arguments[i] == "--budget" && std::atof(value.c_str()) > 0) {
      options.budget = std::atof(value.c_str());
    } else if (arguments[i] == "--nodes") {
      options.levels.clear();
      std::istringstream list(value);
      for (std::string nodes; std::getline(list, nodes, ',');) {
        const std::optional<int> level = level_of(nodes);
        if (!level) return {};
        options.levels.push_back(*level);
      }
    } else {
      return {};
    }
    ++i;
  }
  if (!scenes.empty()) options.scenes = scenes;
  return options;
}

void print_header(const EngineScene& scene) {
  const char* title = scene.name == 'H'   ? "H: starts horizontal, hung by two corners"
                      : scene.name == 'B' ? "B: falls on a ball"
                                          : "W: hung by its top edge, wind of 5 m/s";
  std::printf("\n### Scene %s, %s\n\n", title, scene.damping > 0 ? "damping 2/s" : "undamped");
  std::printf(
      "| nodes | engine | setting | Y, N/m | ms a frame | max %% | mean %% | rms speed, m/s | energy, J | "
      "state |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
}

void print(const Row& row) {
  const Competitor& who = row.competitor;
  const Measurement& m = row.measured;
  std::string structural(1, '-');
  if (who.structural > 0) structural = std::to_string(static_cast<int>(who.structural));
  std::printf("| %d | %s | %s | %s | %.3f (%.3f) | ", row.scene.side(), who.engine.c_str(),
              who.setting.c_str(), structural.c_str(), m.median_ms, m.least_ms);
  if (m.complete()) {
    std::printf("%.3g | %.3g | %.3g | %.3f | ", 100 * m.max_strain, 100 * m.mean_strain, m.rms_speed,
                m.energy.back());
  } else {
    std::printf("- | - | - | - | ");
  }
  std::printf("%s |\n", m.state().c_str());
  std::fflush(stdout);
}

void print(const char* title, const std::vector<Requirement>& requirements) {
  for (const Requirement& r : requirements) {
    const char* verdict = !r.holds ? "-" : *r.holds ? "yes" : "**no**";
    std::printf("| %s | %s | %s | %s | %s |\n", title, r.what.c_str(), r.target.c_str(),
                r.measured.empty() ? "not in this run" : r.measured.c_str(), verdict);
  }
  std::fflush(stdout);
}

void print_requirements(const Rows& rows) {
  std::printf("\n### What must be shown\n\n65 x 65 nodes unless said; ratios of medians (of minima).\n\n");
  std::printf("| scene | what | target | measured | holds |\n|---|---|---|---|---|\n");
  for (const double damping : {2.0, 0.0}) {
    const char* title = damping > 0 ? "H damped" : "H undamped";
    print(title, own_requirements(rows, damping));
    if (damping > 0) print(title, energy_requirements(rows));
    print(title, comparisons(rows, damping));
  }
  print("flags", crowd_requirements());
  print("H damped", instruction_set_requirements());
}

/// All competitors in one scene. They take turns, so that what else the machine does falls on all alike.
void run(const EngineScene& scene, double budget, Rows& rows) {
  constexpr int kTurn = 15;  // frames
  const std::vector<Competitor> all = competitors();
  std::vector<Trial> trials;
  for (const Competitor& competitor : all) trials.emplace_back(competitor.make(scene), scene, budget);
  for (int frame = 0; frame < kFrames; frame += kTurn) {
    for (Trial& trial : trials) trial.run(kTurn);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Row row{scene, all[i], trials[i].measurement()};
    print(row);
    rows.add(row);
  }
}

int main(const std::vector<std::string>& arguments) {
  const ThreadLimit alone(1);
  const std::optional<Options> options = parse(arguments);
  if (!options) {
    std::cerr << kUsage;
    return EXIT_FAILURE;
  }
  std::printf(
      "Sheet of 2 m x 2 m, 0.1 kg/m2, 5 s at 60 Hz, one thread, single precision, engines taking turns.\n"
      "Weft and baseline: structural Y, shear 500 N/m, no bending. Bullet (iterations x substeps): "
      "inextensible.\n"
      "ms: CPU time, median of the frames (minimum). Over the last second: max and mean |strain| of "
      "structural\nedges, rms speed of all nodes. Energy: kinetic and height, since the start, at the end. "
      "BROKEN: over 1000 %%.\nEXPLODED: NaN or a box over 8 m. timed only: 5 s would take over %.0f s.\n",
      options->budget);
  Rows rows;
  for (const char name : options->scenes) {
    for (const double damping : {0.0, 2.0}) {
      print_header({name, kMaxLevel, damping});
      for (const int level : options->levels) {
        run({name, level, damping}, options->budget, rows);
      }
    }
  }
  print_requirements(rows);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) { return weft::bench::main({argv + 1, argv + argc}); }
