#include "cli/serve_options.h"

#include <spdlog/spdlog.h>

#include <utility>
#include <variant>

#include "cli/problems.h"
#include "scene/scene.h"

namespace weft::cli {
namespace {

/// Those asked for; all presets if none was.
std::vector<std::string> wanted_scenes(const ServeOptions& options) {
  if (!options.scenes.empty()) return options.scenes;
  std::vector<std::string> all;
  for (const scene::Preset& preset : scene::presets()) all.emplace_back(preset.name);
  return all;
}

/// Sections 6 and 8 of PROTOCOL.md, in the ranges in which the server works as it should.
void add_limits(CLI::App& command, protocol::Limits& limits, host::MakingLimits& making) {
  const auto add = [&](const char* name, auto& limit, double least, double most, const char* what) {
    command.add_option(name, limit, what)->check(CLI::Range(least, most))->capture_default_str();
  };
  add("--made-scenes", making.scenes, 0, 1000, "Scenes that clients with the role admin may make, at a time");
  add("--scene-bytes", making.document_bytes, 1024, 1 << 28, "Bytes of the document of one");
  add("--made-nodes", making.nodes, 0, 1e8, "Nodes of all of them at their finest levels");
  add("--made-colliders", making.colliders, 0, 10'000, "Balls and obstacles of one");
  add("--made-work", making.work, 0, 1e12,
      "Work of the first step of one, in node-substeps (some 20 ns each)");
  add("--message-bytes", limits.message_bytes, 1024, 1 << 20, "Bytes that a client's message may have");
  add("--json-depth", limits.json_depth, 4, 64, "How deep it may be nested");
  add("--messages-per-second", limits.messages_per_second, 1, 100'000, "Messages of a client in a second");
  add("--balls", limits.balls, 0, 1024, "Balls that a scene may have");
  add("--grabs", limits.grabs, 0, 1024, "Points at which viewers may hold a scene");
  add("--frame-bytes", limits.frame_bytes, 4096, 1 << 26,
      "Bytes that a cloth's record may have; the finest levels that have more are not sent");
}

/// The scene `name` held to one level: NAME-level-L. It has so many cloths.
scene::Result load_at(int level, const ServeOptions& options, const std::string& name, std::size_t cloths) {
  std::vector<std::string> overrides = options.overrides;
  const std::string number = std::to_string(level);
  for (std::size_t cloth = 0; cloth < cloths; ++cloth) {
    std::string& levels = overrides.emplace_back("/cloths/");
    levels.append(std::to_string(cloth)).append("/levels={\"min\":").append(number);
    levels.append(",\"max\":").append(number).append("}");
  }
  scene::Result result = scene::load(name, overrides);
  if (auto* scene = std::get_if<scene::Scene>(&result)) {
    scene->name.append("-level-").append(number);
    scene->title.append(", level ").append(number);
    if (scene->name.size() > scene::kLongestSceneName)
      return std::vector<scene::Problem>{{"", scene->name + ": the name has more than " +
                                                  std::to_string(scene::kLongestSceneName) +
                                                  " characters (--split)"}};
  }
  return result;
}

}  // namespace

bool load_scenes(const ServeOptions& options, host::Host& host) {
  bool good = true;
  for (const std::string& name : wanted_scenes(options)) {
    scene::Result result = scene::load(name, options.overrides);
    if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
      print_problems(name, *problems);
      good = false;
      continue;
    }
    auto& whole = std::get<scene::Scene>(result);
    const std::size_t cloths = whole.simulation.cloths.size();
    host.add(std::move(whole));
    for (const int level : options.split) {
      scene::Result held = load_at(level, options, name, cloths);
      if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&held)) {
        spdlog::warn("{} cannot be held to level {} (--split): {}", name, level, problems->front().text());
      } else {
        host.add(std::move(std::get<scene::Scene>(held)));
      }
    }
  }
  return good;
}

void ServeOptions::add_to(CLI::App& command) {
  command.add_option("SCENE,--scene", scenes,
                     "Presets or scene files; the first is shown first (default: all presets)");
  ServingOptions::add_to(command);
  command.add_option("--set", overrides, "POINTER=VALUE changes a value of every scene, as /wind/speed=8")
      ->allow_extra_args(false);
  command
      .add_option(
          "--split", split,
          "Serves each scene once more for each of these levels, held to it, as NAME-level-6; the page "
          "shows them side by side (6,5,4)")
      ->delimiter(',')
      ->check(CLI::Range(kMinLevel, kMaxLevel))
      ->allow_extra_args(false);
  add_limits(command, limits, making);
  command.add_option(
      "--data", folders.data,
      "Folder in which the state of every scene is kept, so that a restart goes on where it was");
  command.add_option("--record", folders.record,
                     "Folder in which everything that is done to a scene is recorded, as NAME.weftrec");
  threads.add_to(command);
  command
      .add_option("--config", config,
                  "File with these options (TOML: port = 8080); the command line and the environment "
                  "(WEFT_PORT) go before it")
      ->check(CLI::ExistingFile);
}

}  // namespace weft::cli
