#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/motion/bone_fit.h"
#include "scene/motion/bvh_file.h"
#include "scene/motion/gltf_file.h"
#include "scene/motion/node_path.h"
#include "scene/motion/skin.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

/// Each node of the first clip has a path of finite poses, or is refused.
void follow(const scene::Skeleton& skeleton) {
  constexpr std::size_t kNodes = 8;  // enough of a figure
  for (std::size_t node = 0; node < std::min(kNodes, skeleton.nodes.size()); ++node) try {
      const scene::Skeleton::Clip& clip = scene::find_clip(skeleton, "");
      for (const PoseWaypoint& point : scene::path_of(skeleton, clip, node, {})) {
        require(point.pose.position.allFinite(), "a path has places");
        require(std::abs(point.pose.orientation.norm() - 1) < 1e-6, "a path has turns");
      }
    } catch (const std::invalid_argument&) {
    }
}

}  // namespace

// A BVH file, or a glTF one with its buffers in it.
void motions(Input input) try {
  const std::string bytes = text_of(input);
  if (bytes.starts_with("HIERARCHY")) {
    follow(scene::parse_bvh(bytes));
    return;
  }
  const scene::GltfDocument document(
      bytes, [](const std::string&) -> std::string { throw std::invalid_argument("names a file"); });
  const scene::Skeleton skeleton = scene::read_gltf(document);
  follow(skeleton);
  for (const scene::BoneCapsule& capsule :
       scene::fit_capsules(skeleton, nullptr, scene::read_skin(document), 1, {}))
    require(capsule.length > 0 && capsule.position.allFinite(), "a bone has a length");
} catch (const std::invalid_argument&) {
}

}  // namespace weft::fuzz
