#include <stdexcept>

#include "scene/readers.h"
#include "scene/start/start_files.h"

namespace weft::scene {

std::vector<Vec3> read_start(const nlohmann::json& value, const std::string& path, Report& report,
                             const SceneFolder& folder, const ClothDescription& cloth) {
  constexpr std::size_t kLongestName = 1000;
  constexpr Range kFrame{0, 1e7}, kTime{0, 1e6, "s"};
  const std::size_t problems = report.count();
  Object object(value, path, report);
  std::string file;
  object.require("file", "a file that Weft has written");
  object.string("file", file, kLongestName);
  StartChoice choice{cloth.name, {}, {}};
  object.string("cloth", choice.cloth, kLongestName);
  int frame = 0;
  if (object.integer("frame", frame, kFrame)) choice.frame = frame;
  double time = 0;
  if (object.number("time", time, kTime)) choice.time = time;
  if (object.has("frame") && object.has("time"))
    object.problem("time", "is given beside frame; one is enough");
  if (report.count() > problems) return {};
  try {
    if (!folder) throw std::invalid_argument("is given by a scene that is not a file itself");
    std::vector<Vec3> nodes =
        nodes_at_level(read_start_file(*folder, file, choice), cloth.base_cells, cloth.initial_level);
    for (const Vec3& node : nodes) {
      if (!(node.array().abs() <= kPosition.max).all())
        throw std::invalid_argument("has a node beyond 10000 m of the origin");
    }
    return nodes;
  } catch (const std::invalid_argument& error) {
    object.problem("file", "is " + nlohmann::json(file).dump() + ", which " + error.what());
    return {};
  }
}

}  // namespace weft::scene
