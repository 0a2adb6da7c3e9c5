#include "scene/motion/motion_files.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scene/beside_file.h"
#include "scene/motion/bvh_file.h"
#include "scene/motion/gltf_file.h"
#include "scene/object.h"

namespace weft::scene {

Skeleton read_builtin_motion(const std::string& name) {
  std::vector<std::string_view> names;
  for (const BuiltinMotion& motion : builtin_motions()) {
    if (motion.name == name) return parse_bvh(motion.text);
    names.push_back(motion.name);
  }
  throw std::invalid_argument("must be one of " + quoted_list(names));
}

Skeleton read_motion_file(const std::filesystem::path& folder, const std::string& file) {
  std::string type = std::filesystem::path(file).extension().string();
  std::transform(type.begin(), type.end(), type.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (type != ".bvh" && type != ".gltf" && type != ".glb")
    throw std::invalid_argument("must be a .bvh, .gltf or .glb file");
  if (type == ".bvh") return parse_bvh(read_beside(folder, file, kMaxMotionBytes));
  return read_gltf(open_gltf(folder, file));
}

const Skeleton& MotionFiles::file(const std::string& name) {
  if (!folder_) throw std::invalid_argument("is given by a scene that is not a file itself");
  return known("file " + name, [&] { return read_motion_file(*folder_, name); });
}

const Skeleton& MotionFiles::builtin(const std::string& name) {
  return known("builtin " + name, [&] { return read_builtin_motion(name); });
}

const Skeleton& MotionFiles::known(const std::string& key, const std::function<Skeleton()>& read) {
  const auto [at, added] = read_.try_emplace(key);
  if (added) {
    try {
      if (read_.size() > kMaxFiles)
        throw std::invalid_argument("is one too many; a scene may have motions of " +
                                    std::to_string(kMaxFiles) + " files");
      at->second.skeleton = read();
    } catch (const std::invalid_argument& error) {
      at->second.problem = error.what();
    }
  }
  if (!at->second.problem.empty()) throw std::invalid_argument(at->second.problem);
  return at->second.skeleton;
}

void MotionFiles::count(std::size_t points) {
  points_ += points;
  if (points_ > kMaxPoints)
    throw std::invalid_argument("makes the paths of all motions of the scene longer than " +
                                std::to_string(kMaxPoints) + " points");
}

}  // namespace weft::scene
