#include <stdexcept>

#include "scene/readers.h"
#include "scene/start/start_files.h"
#include "scene/start/text_lines.h"

namespace weft::scene {

StartMesh read_obj_start(std::string_view text, const StartChoice& choice) {
  if (choice.frame.value_or(0) != 0 || choice.time)
    throw std::invalid_argument("is one frame, as every .obj file is; it can be given no other, and no time");
  StartMesh mesh;
  std::vector<double> u;
  std::vector<std::string_view> names;
  bool inside = false, found = false;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (line.starts_with("o ")) {
      names.push_back(line.substr(2));
      inside = !found && names.back() == choice.cloth;
      found = found || inside;
    } else if (inside && line.starts_with("v ")) {
      line.remove_prefix(2);
      mesh.nodes.emplace_back(take_numbers<3>(line).data());
      if (mesh.nodes.size() > kMaxClothNodes)
        throw std::invalid_argument("has a mesh of more than " + std::to_string(kMaxClothNodes) +
                                    " vertices");
    } else if (inside && line.starts_with("vt ") && u.size() < mesh.nodes.size()) {
      line.remove_prefix(3);
      u.push_back(take_number(line));
    }
  }
  if (!found) refuse_mesh_name(choice, names);
  set_grid(mesh, u);
  return mesh;
}

}  // namespace weft::scene
