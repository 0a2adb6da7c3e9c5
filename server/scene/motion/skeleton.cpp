#include "scene/motion/skeleton.h"

#include <stdexcept>

#include "scene/nearest_name.h"
#include "scene/object.h"

namespace weft::scene {
namespace {

/// Keys before and after a time, and how much of the way between them has gone by.
struct KeySpan {
  std::size_t before, after;
  double share = 0;   ///< 0..1
  double length = 0;  ///< s
};

KeySpan span_at(const std::vector<double>& times, double time) {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  const auto last = static_cast<std::size_t>(next - times.begin());
  if (last == 0) return {0, 0};
  if (next == times.end()) return {last - 1, last - 1};
  const double length = *next - *std::prev(next);
  return {last - 1, last, (time - *std::prev(next)) / length, length};
}

/// The cubic Hermite spline of glTF 2.0, Appendix C.5.
template <class Vector, class Of>
Vector spline_at(const KeySpan& span, Of of) {
  constexpr std::size_t kTangentIn = 0, kValue = 1, kTangentOut = 2;
  const double t = span.share, t2 = t * t, t3 = t2 * t;
  if (span.before == span.after) return of(3 * span.before + kValue);
  return (2 * t3 - 3 * t2 + 1) * of(3 * span.before + kValue) +
         span.length * (t3 - 2 * t2 + t) * of(3 * span.before + kTangentOut) +
         (-2 * t3 + 3 * t2) * of(3 * span.after + kValue) +
         span.length * (t3 - t2) * of(3 * span.after + kTangentIn);
}

}  // namespace

Vec3 value_at(const Track<Vec3>& track, double time) {
  const KeySpan span = span_at(track.times, time);
  const std::vector<Vec3>& values = track.values;
  if (track.interpolation == Interpolation::cubic)
    return spline_at<Vec3>(span, [&](std::size_t i) { return values[i]; });
  if (track.interpolation == Interpolation::step) return values[span.before];
  return values[span.before] + span.share * (values[span.after] - values[span.before]);
}

Quaternion value_at(const Track<Quaternion>& track, double time) {
  const KeySpan span = span_at(track.times, time);
  const std::vector<Quaternion>& values = track.values;
  if (track.interpolation == Interpolation::cubic) {
    const Eigen::Vector4d sum =
        spline_at<Eigen::Vector4d>(span, [&](std::size_t i) { return Eigen::Vector4d(values[i].coeffs()); });
    if (!(sum.norm() > 0)) return values[3 * span.before + 1].normalized();
    return Quaternion(Eigen::Vector4d(sum.normalized()));
  }
  if (track.interpolation == Interpolation::step) return values[span.before].normalized();
  return values[span.before].slerp(span.share, values[span.after]).normalized();
}

void check_depth(const Skeleton& skeleton) {
  for (const Skeleton::Node& node : skeleton.nodes) {
    std::size_t above = 0;
    for (int at = node.parent; at >= 0; at = skeleton.nodes[static_cast<std::size_t>(at)].parent) {
      if (++above > kMaxSkeletonDepth)
        throw std::invalid_argument("has more than " + std::to_string(kMaxSkeletonDepth) +
                                    " nodes above node \"" + node.name + "\", or it is its own ancestor");
    }
  }
}

std::size_t find_node(const Skeleton& skeleton, std::string_view name) {
  std::vector<std::string_view> names;
  std::size_t found = 0, count = 0;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    names.emplace_back(skeleton.nodes[i].name);
    if (skeleton.nodes[i].name != name) continue;
    found = i;
    ++count;
  }
  if (count == 1) return found;
  const std::string quoted = quoted_list({name});
  if (count > 1)
    throw std::invalid_argument("has " + std::to_string(count) + " nodes of the name " + quoted +
                                "; must have one");
  throw std::invalid_argument("has no node " + quoted + did_you_mean(std::string(name), names));
}

Pose pose_at(const Skeleton& skeleton, const Skeleton::Clip* clip, std::size_t node, double time) {
  std::vector<std::size_t> chain;  // from the node up
  for (int i = static_cast<int>(node); i >= 0; i = skeleton.nodes[static_cast<std::size_t>(i)].parent)
    chain.push_back(static_cast<std::size_t>(i));
  Pose pose;
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
    const Skeleton::Node& joint = skeleton.nodes[*at];
    Vec3 translation = joint.translation;
    Quaternion rotation = joint.rotation;
    if (clip != nullptr) {
      const Skeleton::Motion& motion = clip->nodes[*at];
      if (!motion.translation.empty()) translation = value_at(motion.translation, clip->begin + time);
      if (!motion.rotation.empty()) rotation = value_at(motion.rotation, clip->begin + time);
    }
    pose.position += frame * translation;
    pose.orientation = pose.orientation * rotation;
    frame = frame * rotation.toRotationMatrix() * joint.scale.asDiagonal();
  }
  pose.orientation.normalize();
  return pose;
}

}  // namespace weft::scene
