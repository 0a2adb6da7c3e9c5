#pragma once
#include <string>
#include <vector>

#include "scene/motion/skeleton.h"

namespace weft::scene {

/// How the file's world lies in the scene's, and when its clip is played.
struct Placement {
  double scale = 1;                                 ///< of the file's lengths, > 0: 0.01 where they are cm
  Vec3 offset{0, 0, 0};                             ///< of the file's origin, m
  Quaternion orientation = Quaternion::Identity();  ///< of the file's axes
  double start = 0;   ///< s, of the scene, when the clip begins; the node is where that begins until then
  bool loop = false;  ///< it begins anew when it ends
};

/// Most points that a node's path has: longer clips are sampled evenly, and more coarsely than they say.
inline constexpr std::size_t kMaxPathPoints = 10'000;
inline constexpr double kLongestClip = 1000;  ///< s

/// The clip of that name, or the first one if it is empty. Throws std::invalid_argument if there is none.
const Skeleton::Clip& find_clip(const Skeleton& skeleton, const std::string& name);

/// The node's way through the clip in the scene, sampled at its interval, m and s. A path that loops ends
/// where it begins: where the clip does not, one more interval leads back, which must be no farther than
/// twice what the node goes in another one, or 1 cm, and turn it no more than so, or 5 degrees. Throws
/// std::invalid_argument if it is farther, if the clip is too long, if a node above changes its scale or if
/// the path leaves 10 km around the origin.
std::vector<PoseWaypoint> path_of(const Skeleton& skeleton, const Skeleton::Clip& clip, std::size_t node,
                                  const Placement& placement);

}  // namespace weft::scene
