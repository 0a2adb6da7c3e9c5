#include "scene/scene.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "scene/document.h"
#include "scene/nearest_name.h"
#include "scene/overrides.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

/// A file's name without folders and extension, as a scene's name: 1 to kLongestSceneName of a-z, 0-9 and -.
std::string name_of_file(const std::string& file) {
  std::string name;
  for (const char c : std::filesystem::path(file).stem().string()) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    name += upper ? static_cast<char>(c - 'A' + 'a') : plain ? c : '-';
  }
  name.resize(std::min(name.size(), kLongestSceneName));
  return name.empty() ? "scene" : name;
}

/// The presets, and which of them was probably meant.
std::string preset_names(const std::string& given) {
  std::string text;
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    text += (text.empty() ? "" : ", ") + std::string(preset.name);
    names.push_back(preset.name);
  }
  return text + did_you_mean(given, names);
}

Result read_text(std::string_view text, std::string_view name, const SceneFolder& folder,
                 const std::vector<std::string>& overrides) {
  Document document = read_document(text);
  if (!document.readable) return std::move(document.problems);
  for (const std::string& override_text : overrides) {
    if (auto problem = apply_override(override_text, document.tree))
      document.problems.push_back(std::move(*problem));
  }
  Result result =
      read_scene(document.tree, name, folder, std::move(document.problems), std::move(document.overflows));
  if (auto* scene = std::get_if<Scene>(&result)) {
    scene->document = document.tree.dump();
    // A file that is named alone is in the present folder.
    if (folder) scene->folder = std::filesystem::absolute(folder->empty() ? "." : *folder).string();
  }
  return result;
}

}  // namespace

Result parse(std::string_view text, std::string_view name) { return read_text(text, name, {}, {}); }

Result parse_beside(std::string_view text, std::string_view name, const std::string& folder) {
  return read_text(text, name, folder.empty() ? SceneFolder() : SceneFolder(folder), {});
}

Result from_json(const nlohmann::json& document, std::string_view name) {
  return read_scene(document, name, {}, {}, {});
}

Result load(const std::string& preset_or_file, const std::vector<std::string>& overrides) {
  for (const Preset& preset : presets()) {
    if (preset.name == preset_or_file) return read_text(preset.text, preset.name, {}, overrides);
  }
  const auto text = read_text_file(preset_or_file);
  if (!text) {
    return std::vector<Problem>{{"", preset_or_file + ": " + std::strerror(errno) +
                                         " (neither a file nor a preset; the presets are " +
                                         preset_names(preset_or_file) + ")"}};
  }
  return read_text(*text, name_of_file(preset_or_file), std::filesystem::path(preset_or_file).parent_path(),
                   overrides);
}

}  // namespace weft::scene
