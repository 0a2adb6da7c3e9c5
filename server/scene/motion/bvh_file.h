#pragma once
#include <string_view>

#include "scene/motion/skeleton.h"

namespace weft::scene {

inline constexpr std::size_t kMaxBvhNumbers = 4'000'000;  ///< of all frames

/// The skeleton and the one clip in the text of a BVH file (Biovision; Meredith and Maddock, Motion Capture
/// File Formats Explained, 2001). A joint's rotations apply in the order in which its channels are listed,
/// the last one first. Where a joint has channels of position these are its place in its parent's frame, in
/// place of OFFSET, as Blender and MotionBuilder have it. The end of joint "Head" is the node "Head_end",
/// "Head_end_2" if there are two. Throws std::invalid_argument, saying what is wrong and in which line.
Skeleton parse_bvh(std::string_view text);

}  // namespace weft::scene
