#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/problems.h"
#include "cli/progress.h"
#include "cli/writers/output_file.h"
#include "cloth/core/parallel.h"
#include "scene/scene.h"
#include "study/effects.h"
#include "study/quality.h"
#include "study/report.h"

namespace weft::cli {
namespace {

struct CostOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<int> levels;
  std::vector<std::string> integrators;
  double duration = 2;
  double budget = 60;
  std::string html, csv;
  bool effects = false;
};

/// "4-7", "5" or "4,6" -> ascending levels; a CLI::ValidationError names what is wrong.
std::vector<int> parse_levels(const std::string& text) {
  const auto refuse = [&] {
    return CLI::ValidationError("--levels", "is \"" + text + "\"; must be levels " +
                                                std::to_string(kMinLevel) + " to " +
                                                std::to_string(kMaxLevel) + ", as 4-7 or 4,6");
  };
  const auto number = [&](const std::string& digits) {
    int level = 0;
    if (!CLI::detail::lexical_cast(digits, level) || level < kMinLevel || level > kMaxLevel) throw refuse();
    return level;
  };
  std::vector<int> levels;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const auto dash = part.find('-');
    const int first = number(part.substr(0, dash));
    const int last = dash == std::string::npos ? first : number(part.substr(dash + 1));
    for (int level = first; level <= last; ++level) levels.push_back(level);
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  if (levels.empty()) throw refuse();
  return levels;
}

/// The processor's name as the kernel has it.
std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

/// Those asked for, else all that some cloth of the scene has.
std::vector<int> levels_of(const CostOptions& options, const scene::Scene& scene) {
  return options.levels.empty() ? study::levels_of(scene.simulation) : options.levels;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

study::StudyPlan plan_of(const CostOptions& options, const scene::Scene& scene, int frames) {
  study::StudyPlan plan;
  plan.levels = levels_of(options, scene);
  for (const std::string_view name : study::integrator_names()) {
    const auto& asked = options.integrators;
    if (asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end()) {
      plan.integrators.push_back(name);
    }
  }
  plan.frames = frames;
  plan.budget = options.budget;
  return plan;
}

/// What a reader types to make the study again.
std::string command_of(const CostOptions& options, const study::StudyPlan& plan) {
  std::ostringstream text;
  const auto list = [&](const char* option, const auto& values) {
    text << ' ' << option << ' ';
    for (std::size_t i = 0; i < values.size(); ++i) text << (i > 0 ? "," : "") << values[i];
  };
  text << "weft cost " << options.scene;
  list("--levels", plan.levels);
  list("--integrators", plan.integrators);
  text << " --duration " << options.duration << " --budget " << plan.budget << "s";
  for (const std::string& each : options.overrides) text << " --set '" << each << "'";
  return text.str();
}

/// Steps of the scene that fit into --duration; 0 if there are none or too many, which has been said.
int frames_of(const CostOptions& options, const scene::Scene& scene) {
  const double frames = std::round(options.duration / scene.simulation.time_step);
  if (frames >= 1 && frames <= study::kMaxFrames) return static_cast<int>(frames);
  std::fprintf(stderr, "weft: --duration is %g s, %g steps of this scene; must be 1 to %d steps\n",
               options.duration, frames, study::kMaxFrames);
  return 0;
}

int study_scene(const CostOptions& options, const scene::Scene& scene, int frames) {
  const study::StudyPlan plan = plan_of(options, scene, frames);
  std::vector<std::pair<OutputFile, std::string (*)(const study::Study&, const study::Heading&)>> files;
  if (!options.html.empty()) files.emplace_back(OutputFile(options.html), study::html);
  if (!options.csv.empty()) files.emplace_back(OutputFile(options.csv), study::csv);

  study::Study study;
  {
    const int budget = static_cast<int>(std::ceil(plan.budget));
    Progress progress("cost of " + scene.name, budget, "s of the budget");
    const double begin = now();
    study = study::study_cost(scene.simulation, plan, now,
                              [&] { progress.show(std::min(budget, static_cast<int>(now() - begin))); });
  }
  const study::Heading heading{scene.name, scene.title, command_of(options, plan), machine()};
  for (auto& [file, report] : files) {
    file.write(report(study, heading));
    file.close();
  }
  std::printf("%s: %d frames, %g s simulated, one thread of %s\n\n%s", scene.name.c_str(), study.frames,
              study.frames * study.time_step, heading.machine.c_str(), study::table(study).c_str());
  if (!study.any_done()) {
    std::fprintf(stderr, "weft: no run of %s stayed sound within the budget\n", scene.name.c_str());
    return kBadState;
  }
  return 0;
}

int study_effects(const CostOptions& options, const scene::Scene& scene, int frames) {
  const std::vector<int> levels = levels_of(options, scene);
  std::string text;
  {
    Progress progress("effects of " + scene.name, frames * static_cast<int>(levels.size()));
    int done = 0;
    for (const int level : levels) {
      text +=
          study::table(study::study_effects(scene.simulation, level, frames, [&] { progress.show(++done); }));
    }
  }
  std::printf("%s: %d frames, one thread of %s\n%s", scene.name.c_str(), frames, machine().c_str(),
              text.c_str());
  return 0;
}

int cost(const CostOptions& options) {
  const ThreadLimit alone(1);  // whose processor time is what is measured
  const scene::Result result = scene::load(options.scene, options.overrides);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
    print_problems(options.scene, *problems);
    return kBadUsage;
  }
  const auto& scene = std::get<scene::Scene>(result);
  const int frames = frames_of(options, scene);
  if (frames == 0) return kBadUsage;
  return options.effects ? study_effects(options, scene, frames) : study_scene(options, scene, frames);
}

}  // namespace

void add_cost(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CostOptions>();
  CLI::App* command =
      app.add_subcommand("cost", "Measures what accuracy costs: levels, integrators, step sizes of a scene");
  command->add_option("SCENE", options->scene, "A preset's name (weft check --list) or a scene file")
      ->required();
  command->add_option_function<std::string>(
      "--levels", [options](const std::string& text) { options->levels = parse_levels(text); },
      "As 4-7 or 4,6 (default: those of the scene's cloths)");
  auto* integrators = command
                          ->add_option("--integrators", options->integrators,
                                       "Some of bdf2, backward_euler, xpbd, symplectic_euler (default: all)")
                          ->delimiter(',')
                          ->check(CLI::IsMember(std::vector<std::string>(study::integrator_names().begin(),
                                                                         study::integrator_names().end())));
  command->add_option("--duration", options->duration, "Seconds of the scene that are studied")
      ->check(CLI::Range(1e-9, 1e6))
      ->capture_default_str();
  auto* budget =
      command
          ->add_option("--budget", options->budget,
                       "Wall time for the whole study, as 60s or 5min; what does not fit is skipped")
          ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                            CLI::AsNumberWithUnit::CASE_SENSITIVE))
          ->check(CLI::Range(1e-9, 1e6))
          ->capture_default_str();
  auto* html = command->add_option("--out", options->html, "Work-precision diagrams, as one HTML page");
  auto* csv = command->add_option("--csv", options->csv, "Every run, as CSV");
  command
      ->add_flag("--effects", options->effects,
                 "Instead: the milliseconds of each effect, from the scene with and without it")
      ->excludes(integrators, budget, html, csv);
  command
      ->add_option("--set", options->overrides,
                   "POINTER=VALUE changes a value of the scene, as /wind/speed=8")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = cost(*options); });
}

}  // namespace weft::cli
