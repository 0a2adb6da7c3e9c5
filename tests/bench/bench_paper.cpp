/// Milliseconds a frame of the paper's own method: Weft beside the baseline, in one run, taking turns, with
/// the same substeps in the same precision. Prints a Markdown table; the paper's figures (its section 4)
/// stand beside.
///   bench_paper [REPETITIONS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "baseline.h"
#include "cloth/core/parallel.h"
#include "scene/scene.h"
#include "timing.h"

namespace weft::bench {
namespace {

/// A repetition lasts at least this long, so that the clock's grain and one interruption do not matter, ms.
constexpr double kLeastRepetition = 30.0;
/// Simulated before measuring, so that the cloth hangs, flutters and touches the ball, s.
constexpr double kWarmUp = 4.0;

/// Milliseconds of one frame, over `frames` of them.
template <class Stepped>
double frame_time(Stepped& stepped, int frames) {
  const double begin = now();
  for (int i = 0; i < frames; ++i) stepped.step();
  return (now() - begin) / frames;
}

struct Row {
  int substeps = 0;
  double weft = 0, baseline = 0, baseline_double = 0;  ///< median ms a frame
};

Row measure(SimulationDescription scene, int level, int repetitions) {
  scene.cloths[0].initial_level = level;
  scene.sleep_speed = 0;  // every step is measured
  Simulation<float> weft(scene);
  Simulation<double> state(scene);
  for (double t = 0; t < kWarmUp; t += scene.time_step) weft.step();
  for (double t = 0; t < kWarmUp; t += scene.time_step) state.step();
  Row row;
  row.substeps = weft.report(0).substeps;
  Baseline<float> baseline(weft, row.substeps);
  Baseline<double> baseline_double(state, row.substeps);

  const int frames = 1 + static_cast<int>(kLeastRepetition / std::max(1e-3, frame_time(weft, 1)));
  const int baseline_frames =
      1 + static_cast<int>(kLeastRepetition / std::max(1e-3, frame_time(baseline, 1)));
  std::vector<double> weft_times, times, double_times;
  for (int i = 0; i < repetitions; ++i) {
    weft_times.push_back(frame_time(weft, frames));
    times.push_back(frame_time(baseline, baseline_frames));
    double_times.push_back(frame_time(baseline_double, baseline_frames));
  }
  if (weft.cloths()[0].guard_counters().all_redone() > 0 || weft.report(0).substeps != row.substeps) {
    std::cerr << "the cloth did not stay sound or changed its substeps: no measurement\n";
    std::exit(EXIT_FAILURE);
  }
  row.weft = median(weft_times);
  row.baseline = median(times);
  row.baseline_double = median(double_times);
  return row;
}

/// A cloth of 2 m as in most scenes, hung by two corners, 60 frames a second, without wind or ball.
SimulationDescription hung_cloth() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.discretization = Discretization::paper;
  cloth.material.damping = 1e-4;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.perturbation = 0.001;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = SymplecticEulerDescription{};
  return scene;
}

void print(const char* name, const SimulationDescription& scene, int repetitions) {
  struct Level {
    int level, cells;
    double paper;  ///< the paper's ms a frame, from its discussion of Fig. 6
  };
  for (const Level& at : {Level{6, 64, 54}, Level{5, 32, 16}, Level{4, 16, 5}}) {
    const Row row = measure(scene, at.level, repetitions);
    std::printf("| %s | %d x %d | %.1f | %d | %.3f | %.3f | %.3f | %.1f | %.0f |\n", name, at.cells, at.cells,
                1e3 * scene.time_step, row.substeps, row.weft, row.baseline, row.baseline_double,
                row.baseline / row.weft, at.paper);
    std::fflush(stdout);
  }
}

int main(int argc, char** argv) {
  const ThreadLimit alone(1);
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 15;
  if (repetitions < 1) {
    std::cerr << "usage: bench_paper [REPETITIONS]\n";
    return EXIT_FAILURE;
  }
  std::printf("CPU ms a frame, median of %d turns; Weft and baseline in float unless said.\n\n", repetitions);
  std::printf(
      "| scene | cells | ms simulated a frame | substeps | Weft | baseline | baseline, double | "
      "baseline / Weft | the paper |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  print("hung by two corners", hung_cloth(), repetitions);
  for (const scene::Preset& preset : scene::presets()) {
    if (!preset.name.starts_with("zheng2020-")) continue;
    const scene::Result result = scene::parse(preset.text, preset.name);
    if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
      std::cerr << preset.name << ": " << problems->front().text() << "\n";
      return EXIT_FAILURE;
    }
    const auto& loaded = std::get<scene::Scene>(result);
    print(loaded.name.c_str(), loaded.simulation, repetitions);
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) { return weft::bench::main(argc, argv); }
