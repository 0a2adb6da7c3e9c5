#include <stdexcept>

#include "scene/start/start_files.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

scene::StartMesh read(std::string_view bytes, const scene::StartChoice& choice) {
  if (bytes.starts_with("glTF")) return scene::read_glb_start(bytes, choice);
  if (bytes.starts_with("#usda")) return scene::read_usda_start(bytes, choice);
  if (bytes.starts_with("frame,")) return scene::read_csv_start(bytes, choice);
  if (bytes.starts_with("POINTCACHE2")) return scene::read_pc2_start(bytes, choice);
  if (bytes.starts_with("o ")) return scene::read_obj_start(bytes, choice);
  return scene::read_mdd_start(bytes, choice);
}

}  // namespace

// A file that a cloth starts from: each frame that can be chosen is a grid that can be brought to other
// levels, or is refused.
void starts(Input input) {
  const std::string bytes = text_of(input);
  for (const scene::StartChoice& choice :
       {scene::StartChoice{"cloth", {}, {}}, {"cloth", 0, {}}, {"cloth", {}, 0.02}})
    try {
      const scene::StartMesh mesh = read(bytes, choice);
      require(mesh.rows == 0 || mesh.nodes.size() == std::size_t(mesh.rows) * std::size_t(mesh.cols),
              "a grid has all its nodes");
      for (const int level : {3, 4})
        require(scene::nodes_at_level(mesh, {1, 1}, level).size() == (level == 3 ? 81 : 289),
                "a start has a place for each node");
    } catch (const std::invalid_argument&) {
    }
}

}  // namespace weft::fuzz
