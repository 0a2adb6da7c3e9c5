#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "cloth/core/path.h"
#include "cloth/core/vec3.h"

namespace weft::scene {

inline constexpr std::size_t kMaxSkeletonNodes = 10'000;  ///< of one file
inline constexpr std::size_t kMaxSkeletonDepth = 256;     ///< nodes above another
inline constexpr std::size_t kMaxNodeName = 256;          ///< characters

/// How values are found between two keys, as glTF 2.0 has it (Appendix C).
enum class Interpolation { step, linear, cubic };

/// What takes values at keys: before the first and after the last it keeps those.
template <class Value>
struct Track {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< s, ascending, one at least if there are values
  std::vector<Value> values;  ///< one a key; cubic three: the tangent into it, per s, the value, the one out
  bool empty() const { return times.empty(); }
};

/// At `time`, s, of a track that is not empty. Quaternions turn the shorter way round, and are of length 1.
Vec3 value_at(const Track<Vec3>& track, double time);
Quaternion value_at(const Track<Quaternion>& track, double time);

/// A tree of frames that move: a skeleton and the motions that were recorded or made for it. Lengths are the
/// file's own.
struct Skeleton {
  struct Node {
    std::string name;  ///< not always one of its own
    int parent = -1;   ///< -1: none. Following parents ends
    Vec3 translation{0, 0, 0};
    Quaternion rotation = Quaternion::Identity();  ///< to the parent's frame
    Vec3 scale{1, 1, 1};                           ///< along its own axes; > 0
    bool end = false;                              ///< a place where a bone ends, not a joint: BVH's End Site
  };
  /// Instead of what the node itself says, where there is a track.
  struct Motion {
    Track<Vec3> translation;
    Track<Quaternion> rotation;
    bool scales = false;  ///< the file changes its scale, which is not read
  };
  struct Clip {
    std::string name;           ///< empty if the file gives none
    double begin = 0;           ///< s, of its first key
    double duration = 0;        ///< s, from its first to its last key
    double interval = 0;        ///< s, in which it is to be sampled; > 0
    std::vector<Motion> nodes;  ///< of each node
  };
  std::vector<Node> nodes;
  std::vector<Clip> clips;
};

/// Throws std::invalid_argument if a node has more than kMaxSkeletonDepth above it, as one that is its own
/// ancestor has.
void check_depth(const Skeleton& skeleton);

/// The only node of that name. Throws std::invalid_argument if there is none, with the most similar name, or
/// if there are several.
std::size_t find_node(const Skeleton& skeleton, std::string_view name);

/// Where the node is in the file's world and how it is turned there, `time` s after the clip's begin; as the
/// nodes themselves say without a clip. Scales of the nodes above stretch its place, not its turn.
Pose pose_at(const Skeleton& skeleton, const Skeleton::Clip* clip, std::size_t node, double time);

}  // namespace weft::scene
