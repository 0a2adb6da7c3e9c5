#include <stdexcept>

#include "scene/motion/node_path.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr const char* kMotionFile = "file";
constexpr const char* kMotionBuiltin = "builtin";

}  // namespace

PosePath read_motion(const json& value, const std::string& path, Report& report, MotionFiles& motions) {
  constexpr std::size_t kLongestName = 1000;
  constexpr Range kScale{1e-6, 1e6}, kStart{0, 1e6, "s"};
  const std::size_t problems = report.count();
  Object object(value, path, report);
  const bool builtin = object.has(kMotionBuiltin);
  if (object.has(kMotionFile) == builtin)
    object.problem(kMotionFile, "must be given, or " + std::string(kMotionBuiltin) + ", and not both");
  const char* source = builtin ? kMotionBuiltin : kMotionFile;
  std::string name, node, animation;
  object.string(source, name, kLongestName);
  object.require("node", "a node's name");
  object.string("node", node, kMaxNodeName);
  object.string("animation", animation, kMaxNodeName);
  Placement placement;
  object.number("scale", placement.scale, kScale);
  object.vector("offset", placement.offset, kPosition);
  placement.orientation = read_turn(object, placement.orientation);
  object.number("start", placement.start, kStart);
  object.boolean("loop", placement.loop);
  if (report.count() > problems) return {};
  try {
    const Skeleton& skeleton = builtin ? motions.builtin(name) : motions.file(name);
    std::vector<PoseWaypoint> points =
        path_of(skeleton, find_clip(skeleton, animation), find_node(skeleton, node), placement);
    motions.count(points.size());
    return {std::move(points), placement.loop};
  } catch (const std::invalid_argument& error) {
    object.problem(source, "is " + json(name).dump() + ", which " + error.what());
    return {};
  }
}

}  // namespace weft::scene
