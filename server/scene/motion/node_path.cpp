#include "scene/motion/node_path.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "scene/nearest_name.h"

namespace weft::scene {
namespace {

std::string text_of(const char* format, double a, double b = 0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

void check_scales(const Skeleton& skeleton, const Skeleton::Clip& clip, std::size_t node) {
  for (int at = skeleton.nodes[node].parent; at >= 0;) {
    const auto i = static_cast<std::size_t>(at);
    if (clip.nodes[i].scales)
      throw std::invalid_argument("changes the scale of node \"" + skeleton.nodes[i].name +
                                  "\"; scales must stay as they are");
    at = skeleton.nodes[i].parent;
  }
}

/// Leads the path back to where it begins.
void close(std::vector<PoseWaypoint>& path, double interval) {
  constexpr double kFreeWay = 0.01, kFreeTurn = 5 * std::numbers::pi / 180;
  double way = kFreeWay / 2, turn = kFreeTurn / 2;
  for (std::size_t i = 1; i < path.size(); ++i) {
    way = std::max(way, (path[i].pose.position - path[i - 1].pose.position).norm());
    turn = std::max(turn, path[i].pose.orientation.angularDistance(path[i - 1].pose.orientation));
  }
  const Pose &first = path.front().pose, &last = path.back().pose;
  const double gap = (last.position - first.position).norm();
  const double twist = last.orientation.angularDistance(first.orientation);
  if (gap > 2 * way || twist > 2 * turn)
    throw std::invalid_argument(text_of("does not end where it begins: %.3g m and %.3g degrees apart", gap,
                                        twist * 180 / std::numbers::pi) +
                                ", which cannot loop");
  constexpr double kSame = 1e-6;
  if (gap < kSame && twist < kSame && path.size() > 1) {
    path.back().pose = first;
  } else {
    path.push_back({path.back().time + interval, first});
  }
}

}  // namespace

const Skeleton::Clip& find_clip(const Skeleton& skeleton, const std::string& name) {
  if (skeleton.clips.empty()) throw std::invalid_argument("has no animation");
  if (name.empty()) return skeleton.clips.front();
  std::vector<std::string_view> names;
  for (const Skeleton::Clip& clip : skeleton.clips) {
    if (clip.name == name) return clip;
    names.emplace_back(clip.name);
  }
  throw std::invalid_argument("has no animation \"" + name + "\"" + did_you_mean(name, names));
}

std::vector<PoseWaypoint> path_of(const Skeleton& skeleton, const Skeleton::Clip& clip, std::size_t node,
                                  const Placement& placement) {
  constexpr double kFarthest = 1e4;  // m, as all positions of a scene
  if (clip.duration > kLongestClip)
    throw std::invalid_argument(text_of("lasts %g s; at most %g s are allowed", clip.duration, kLongestClip));
  check_scales(skeleton, clip, node);
  // A whole number of samples to the very end, the last of which a loop may need.
  const double wanted = std::ceil(clip.duration / clip.interval - 1e-6);
  const auto count = static_cast<std::size_t>(std::min(wanted, static_cast<double>(kMaxPathPoints - 2)));
  const double interval = count > 0 ? clip.duration / static_cast<double>(count) : clip.interval;
  std::vector<PoseWaypoint> path;
  path.reserve(count + 2);
  for (std::size_t i = 0; i <= count; ++i) {
    const double time = interval * static_cast<double>(i);
    const Pose pose = pose_at(skeleton, &clip, node, time);
    const Vec3 position = placement.orientation * (placement.scale * pose.position) + placement.offset;
    if (!(position.array().abs() <= kFarthest).all())
      throw std::invalid_argument(
          "has node \"" + skeleton.nodes[node].name +
          text_of("\" beyond %g m of the origin at %g s; scale tells the file's unit", kFarthest, time));
    path.push_back(
        {placement.start + time, {position, (placement.orientation * pose.orientation).normalized()}});
  }
  if (placement.loop) close(path, interval);
  return path;
}

}  // namespace weft::scene
