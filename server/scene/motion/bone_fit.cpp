#include "scene/motion/bone_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace weft::scene {
namespace {

/// A bone as seen from its joint, in the joint's own lengths: from `begin` to `end`.
struct Bone {
  Vec3 begin{0, 0, 0}, end{0, 0, 0};
  double length() const { return (end - begin).norm(); }
  /// How far along it, of its length, the point's foot is.
  double share_at(const Vec3& point) const {
    return (point - begin).dot(end - begin) / (end - begin).squaredNorm();
  }
  double distance_to_line(const Vec3& point) const {
    return (point - begin - share_at(point) * (end - begin)).norm();
  }
  double distance(const Vec3& point) const {
    return (point - begin - std::clamp(share_at(point), 0.0, 1.0) * (end - begin)).norm();
  }
};

/// The value below which `share` of them are; they are put into order.
double quantile(std::vector<double>& values, double share) {
  const auto at = std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

constexpr std::size_t kFewestVertices = 8;  ///< vertices that tell a radius

/// Of the vertices beside the bone that are nearest to it of all the joint's bones.
std::optional<double> radius_by_skin(const std::vector<Vec3>& vertices, const std::vector<Bone>& bones,
                                     const Bone& bone, double share) {
  std::vector<double> distances;
  for (const Vec3& vertex : vertices) {
    const double along = bone.share_at(vertex);
    if (!(along >= 0 && along <= 1)) continue;
    const double own = bone.distance(vertex);
    const bool nearest = std::all_of(bones.begin(), bones.end(),
                                     [&](const Bone& other) { return own <= other.distance(vertex); });
    if (nearest) distances.push_back(bone.distance_to_line(vertex));
  }
  if (distances.size() < kFewestVertices) return {};
  return quantile(distances, share);
}

/// Of a joint without children: through the middle of its vertices, as far as they reach but for a radius.
std::optional<Bone> bone_of_skin(const std::vector<Vec3>& vertices, double share) {
  if (vertices.size() < kFewestVertices) return {};
  Vec3 middle(0, 0, 0);
  for (const Vec3& vertex : vertices) middle += vertex / static_cast<double>(vertices.size());
  if (!(middle.norm() > 0)) return {};
  const Vec3 axis = middle.normalized();
  std::vector<double> reaches, distances;
  for (const Vec3& vertex : vertices) {
    reaches.push_back(vertex.dot(axis));
    distances.push_back(across(vertex, axis).norm());
  }
  const double reach = *std::max_element(reaches.begin(), reaches.end());
  const double end = reach - quantile(distances, share);
  const double begin = std::min(middle.norm(), end);
  return Bone{begin > 0 ? Vec3(0, 0, 0) : Vec3(begin * axis), std::max(end, 0.1 * reach) * axis};
}

/// Of each node, those that hang on it.
std::vector<std::vector<std::size_t>> children_of(const Skeleton& skeleton) {
  std::vector<std::vector<std::size_t>> children(skeleton.nodes.size());
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const int parent = skeleton.nodes[i].parent;
    if (parent >= 0) children[static_cast<std::size_t>(parent)].push_back(i);
  }
  return children;
}

/// A node's translation at the clip's begin.
Vec3 begin_of(const Skeleton& skeleton, const Skeleton::Clip* clip, std::size_t node) {
  if (clip == nullptr || clip->nodes[node].translation.empty()) return skeleton.nodes[node].translation;
  return value_at(clip->nodes[node].translation, clip->begin);
}

/// What lengths of the node's frame are multiplied by, by itself and all above it: the mean of three axes.
double stretch_of(const Skeleton& skeleton, std::size_t node) {
  double stretch = 1;
  for (int at = static_cast<int>(node); at >= 0; at = skeleton.nodes[static_cast<std::size_t>(at)].parent)
    stretch *= std::cbrt(skeleton.nodes[static_cast<std::size_t>(at)].scale.prod());
  return stretch;
}

/// The nodes that are joints: all that a skin hangs on or, without one, that a clip turns, and all below
/// them; all nodes if there are none. Cameras and props that stand beside a figure are no joints.
std::vector<char> joints_of(const Skeleton& skeleton, const Skeleton::Clip* clip, const Skin& skin) {
  std::vector<char> joints(skeleton.nodes.size(), 0);
  const auto moves = [&](std::size_t node) {
    return skin.empty() ? clip != nullptr && !clip->nodes[node].rotation.empty() : skin.contains(node);
  };
  bool any = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (int at = static_cast<int>(i); at >= 0 && joints[i] == 0;) {
      const auto node = static_cast<std::size_t>(at);
      joints[i] = moves(node) ? 1 : 0;
      at = skeleton.nodes[node].parent;
    }
    any = any || joints[i] != 0;
  }
  if (!any) joints.assign(joints.size(), 1);
  return joints;
}

}  // namespace

double height_of(const Skeleton& skeleton, const Skeleton::Clip* clip) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const double height = pose_at(skeleton, clip, i, 0).position.y();
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return highest - lowest;
}

std::vector<BoneCapsule> fit_capsules(const Skeleton& skeleton, const Skeleton::Clip* clip, const Skin& skin,
                                      double scale, const BoneFitRule& rule) {
  const double height = scale * height_of(skeleton, clip);
  const std::vector<char> joints = joints_of(skeleton, clip, skin);
  const auto children = children_of(skeleton);
  std::map<std::string, double> radii = rule.radii;
  std::vector<BoneCapsule> capsules;
  for (std::size_t node = 0; node < skeleton.nodes.size(); ++node) {
    if (joints[node] == 0 || skeleton.nodes[node].end) continue;
    const auto hung = skin.find(node);
    std::vector<Bone> bones;
    for (const std::size_t child : children[node]) {
      if (joints[child] != 0) bones.push_back({Vec3::Zero(), begin_of(skeleton, clip, child)});
    }
    if (bones.empty() && hung != skin.end()) {
      if (const auto bone = bone_of_skin(hung->second, rule.quantile)) bones.push_back(*bone);
    }
    const double unit = scale * stretch_of(skeleton, node);  // m, of the joint's own lengths
    const auto named = rule.radii.find(skeleton.nodes[node].name);
    for (const Bone& bone : bones) {
      const double length = unit * bone.length();
      if (!(length >= rule.shortest * height) || !(length > 0)) continue;
      BoneCapsule capsule;
      capsule.node = node;
      capsule.length = length;
      capsule.position = unit * (bone.begin + bone.end) / 2;
      capsule.orientation = turn_from_y(bone.end - bone.begin);
      capsule.radius = std::clamp(rule.share * length, rule.thinnest * height, rule.thickest * height);
      if (hung != skin.end()) {
        if (const auto radius = radius_by_skin(hung->second, bones, bone, rule.quantile))
          capsule.radius = unit * *radius;
      }
      if (named != rule.radii.end()) capsule.radius = named->second;
      radii.erase(skeleton.nodes[node].name);
      capsules.push_back(capsule);
    }
  }
  if (!radii.empty()) throw std::invalid_argument("has no bone at a joint \"" + radii.begin()->first + "\"");
  return capsules;
}

}  // namespace weft::scene
