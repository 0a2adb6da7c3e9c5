#pragma once
/// Scene files: JSON -> a description that can be simulated, every error named. Format: scene.schema.json and
/// server/docs/scenes.md.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cloth/world/description.h"
#include "scene/look.h"

namespace weft::scene {

/// Characters that a scene's name may have, which is a part of URLs.
inline constexpr std::size_t kLongestSceneName = 64;

/// One thing wrong with a scene file.
struct Problem {
  std::string path;     ///< JSON pointer, for example /cloths/0/material/density; empty: the whole file
  std::string message;  ///< names the value and the allowed range
  std::string text() const { return path.empty() ? message : path + ": " + message; }
};

/// What the server holds to by choosing how a scene is stepped: at most one of the two.
struct Quality {
  std::optional<double> max_error;  ///< of the steps, in cloth sizes: the cheapest way that meets it
  std::optional<double> max_ms;     ///< wall time of a step: the most accurate way within it
  bool asks() const { return max_error || max_ms; }
};

struct Scene {
  std::string name;   ///< preset or file name without extension: a-z, 0-9 and -, up to kLongestSceneName
  std::string title;  ///< one line for people
  std::vector<std::string> notes;  ///< what was chosen, and why
  double camera_distance = 5.0;    ///< a viewer's distance until it says its own, m
  Vec3 camera_eye{0.0, 0.0, 5.0};  ///< where a page puts its camera at first, m
  Vec3 camera_target{0.0, 0.0, 0.0};
  SimulationDescription simulation;
  std::vector<Look> looks;  ///< of each cloth
  std::string document;     ///< the scene as JSON text, with overrides: what it was read from
  std::string folder;       ///< that files named in it are beside; empty: it may name none
  Quality quality;          ///< asks for nothing: stepped as the simulation says
};

/// The scene, or everything that is wrong with it (all problems at once).
using Result = std::variant<Scene, std::vector<Problem>>;

/// Reads a scene from JSON text. Never throws. Duplicate keys, unknown keys, wrong types, out-of-range and
/// non-finite values are problems; text that is not JSON is one problem that gives line and column.
Result parse(std::string_view text, std::string_view name);

/// As parse, of a text whose files are in `folder`, if it may name any.
Result parse_beside(std::string_view text, std::string_view name, const std::string& folder);

/// As parse, of a document already read; `--set` edits one before this.
Result from_json(const nlohmann::json& document, std::string_view name);

/// Loads SCENE as the command line takes it: a preset's name, else a file's path. `overrides` are
/// JSON-pointer=value (value is JSON, or else a string), applied before checking; null takes the member away,
/// "-" appends to an array.
Result load(const std::string& preset_or_file, const std::vector<std::string>& overrides = {});

/// The preset scenes, in the order they are listed.
struct Preset {
  std::string_view name;
  std::string_view text;  ///< the scene file, compiled in
};
const std::vector<Preset>& presets();

}  // namespace weft::scene
