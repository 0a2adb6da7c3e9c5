#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/motion/skeleton.h"

namespace weft::scene {

inline constexpr std::size_t kMaxMotionBytes = 64u << 20;  ///< of a file

/// The motions that are compiled in, as files are: BVH.
struct BuiltinMotion {
  std::string_view name;
  std::string_view text;
};
const std::vector<BuiltinMotion>& builtin_motions();

/// The skeleton of a built-in motion. Throws std::invalid_argument if there is none of that name.
Skeleton read_builtin_motion(const std::string& name);

/// The skeleton of a .bvh, .gltf or .glb file in the folder, by the rules of read_beside, as its buffers'
/// files are. Throws std::invalid_argument, saying what is wrong.
Skeleton read_motion_file(const std::filesystem::path& folder, const std::string& file);

/// What a scene's motions are read from: each file once, and all paths within one limit.
class MotionFiles {
 public:
  static constexpr std::size_t kMaxPoints = 500'000;  ///< of all paths together
  static constexpr std::size_t kMaxFiles = 16;

  /// `folder` as in read_scene: without one no file may be named.
  explicit MotionFiles(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}
  const Skeleton& file(const std::string& name);
  const Skeleton& builtin(const std::string& name);
  /// Counts a path's points; throws std::invalid_argument if they are too many.
  void count(std::size_t points);

 private:
  struct Read {
    Skeleton skeleton;
    std::string problem;  ///< why there is none; empty if there is
  };
  const Skeleton& known(const std::string& key, const std::function<Skeleton()>& read);

  std::optional<std::filesystem::path> folder_;
  std::map<std::string, Read> read_;
  std::size_t points_ = 0;
};

}  // namespace weft::scene
