#include <spdlog/spdlog.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "cli/serving.h"
#include "cli/threads.h"
#include "cloth/world/state_hash.h"
#include "record/replay.h"

namespace weft::cli {
namespace {

struct ReplayOptions {
  std::string file;
  bool validate = false;
  std::optional<double> seek;
  bool serve = false, loop = false;
  ServingOptions serving;
  Threads threads;
};

void print_summary(const ReplayOptions& options, const record::Recording& recording,
                   const scene::Scene& scene) {
  std::size_t states = 0;
  for (const record::Event& event : recording.events())
    states += std::holds_alternative<record::StateThen>(event) ? 1 : 0;
  std::printf("%s: scene %s, %" PRIu64 " steps (%.3f s), %zu commands, %zu states, by Weft %s\n",
              options.file.c_str(), scene.name.c_str(), recording.steps(),
              static_cast<double>(recording.steps()) * scene.simulation.time_step, recording.commands(),
              states, recording.head().value("weft", "?").c_str());
  if (!recording.damage().empty()) std::printf("  %s: read up to there\n", recording.damage().c_str());
}

void print_place(const record::Replay& replay) {
  std::printf("  step %" PRIu64 ", simulated %.3f s: state %016" PRIx64 "\n", replay.steps(),
              replay.simulation().time(), state_hash(replay.simulation()));
}

/// The step that --seek names; the beginning without it.
std::uint64_t step_sought(const ReplayOptions& options, const scene::Scene& scene) {
  return static_cast<std::uint64_t>(std::llround(options.seek.value_or(0) / scene.simulation.time_step));
}

/// Shows the recording to viewers.
int serve_recording(const ReplayOptions& options) {
  begin_serving(options.serving);
  auto recording = std::make_shared<const record::Recording>(record::Recording::of_file(options.file));
  if (!recording->damage().empty())
    spdlog::warn("{}: {}: it is shown up to there", options.file, recording->damage());
  host::Host host(options.serving.limits, WEFT_VERSION);
  const std::uint64_t from = step_sought(options, recording->scene());
  if (options.loop && from >= recording->steps())
    throw std::invalid_argument("--loop: " + options.file + " has " + std::to_string(recording->steps()) +
                                " steps, and none from --seek on to be shown again and again");
  host.play({recording, from, options.loop});
  serve(host, options.serving);
  return 0;
}

int replay(const ReplayOptions& options) {
  const ThreadLimit limit = options.threads.limit();
  if (options.serve) return serve_recording(options);
  const record::Recording recording = record::Recording::of_file(options.file);
  const scene::Scene scene = recording.scene();
  print_summary(options, recording, scene);
  if (!options.validate && !options.seek) return recording.damage().empty() ? 0 : kFailed;
  record::Replay replay(recording);
  if (options.seek) {
    replay.seek(step_sought(options, scene));
    print_place(replay);
  }
  if (!options.validate) return 0;
  {
    Progress progress("validating " + scene.name, static_cast<int>(recording.steps()), "steps");
    while (!replay.divergence() && replay.step()) progress.show(static_cast<int>(replay.steps()));
  }
  if (const auto& other = replay.divergence()) {
    std::printf("  after %" PRIu64 " steps the state is another: %016" PRIx64 ", recorded was %016" PRIx64
                "\n",
                other->step, other->found, other->recorded);
    return kBadState;
  }
  print_place(replay);
  std::printf("  %zu hashes, all as recorded\n", replay.hashes());
  return recording.damage().empty() ? 0 : kFailed;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Tells what a recording (serve --record) has, does it again, or shows it to viewers. Ends with 1 if it "
      "is damaged, 3 if a state is another");
  command->add_option("FILE", options->file, "Recording")->required()->check(CLI::ExistingFile);
  auto* validate =
      command->add_flag("--validate", options->validate, "Makes every step again and compares all hashes");
  auto* serve = command
                    ->add_flag("--serve", options->serve,
                               "Shows it as a scene in real time, from --seek on, to the page and to clients")
                    ->excludes(validate);
  command->add_flag("--loop", options->loop, "Begins anew at its end, where it pauses otherwise")
      ->needs(serve);
  command
      ->add_option("--seek", options->seek, "Goes to this time since the recording began, s; tells its hash")
      ->check([](const std::string& text) {
        double seconds = -1;
        const bool number = CLI::detail::lexical_cast(text, seconds);
        constexpr double kMost = 1e9;
        return number && seconds >= 0 && seconds <= kMost ? std::string() : text + ": allowed: 0..1e9 (s)";
      });
  const std::vector<CLI::Option*> before = command->get_options();
  options->serving.add_to(*command);
  for (CLI::Option* option : command->get_options()) {
    if (std::find(before.begin(), before.end(), option) == before.end())
      option->needs(serve)->group("With --serve");
  }
  options->threads.add_to(*command);
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace weft::cli
