#include <cctype>
#include <stdexcept>

#include "scene/readers.h"
#include "scene/start/start_files.h"
#include "scene/start/text_lines.h"

namespace weft::scene {
namespace {

/// A name as the writer makes it a prim's: other characters than letters and digits are _, and no digit comes
/// first.
std::string prim_of(const std::string& name) {
  std::string prim = name;
  for (char& c : prim) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  if (!prim.empty() && std::isdigit(static_cast<unsigned char>(prim.front())) != 0) prim.insert(0, 1, '_');
  return prim;
}

/// What follows `key` in the text; nothing if it is not there.
std::optional<std::string_view> after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return {};
  return text.substr(at + key.size());
}

/// The lines of the mesh's prim.
std::string_view prim_text(std::string_view text, const StartChoice& choice) {
  const std::string wanted = prim_of(choice.cloth);
  std::vector<std::string_view> names;
  for (std::optional<std::string_view> rest = text; (rest = after(*rest, "def Mesh \""));) {
    names.push_back(rest->substr(0, rest->find('"')));
    if (names.back() == wanted) return rest->substr(0, rest->find("\n    }"));
  }
  refuse_mesh_name(choice, names);
}

/// The tuples of one line's list.
template <std::size_t width>
std::vector<std::array<double, width>> tuples(std::string_view line) {
  std::vector<std::array<double, width>> all;
  line = line.substr(0, line.find(']'));
  while (line.find_first_of("0123456789") != std::string_view::npos) {
    all.push_back(take_numbers<width>(line));
    if (all.size() > kMaxClothNodes)
      throw std::invalid_argument("has a mesh of more than " + std::to_string(kMaxClothNodes) + " points");
  }
  return all;
}

}  // namespace

StartMesh read_usda_start(std::string_view text, const StartChoice& choice) {
  double rate = 1;
  if (auto told = after(text, "timeCodesPerSecond = ")) rate = take_number(*told);
  if (!(rate > 0)) throw std::invalid_argument("has a timeCodesPerSecond that is not above 0");
  const std::string_view prim = prim_text(text, choice);
  std::optional<std::string_view> samples = after(prim, "point3f[] points.timeSamples = {\n");
  if (!samples) throw std::invalid_argument("has no samples of the mesh's points");
  std::vector<double> times;
  std::vector<std::string_view> points;
  while (samples->find_first_not_of(' ') != samples->find('}')) {
    std::string_view line = take_line(*samples);
    times.push_back(take_number(line) / rate);
    points.push_back(line.substr(std::min(line.size(), line.find('['))));
    if (samples->empty()) throw std::invalid_argument("ends within the samples of the mesh's points");
  }
  Vec3 place(0, 0, 0);
  if (auto told = after(prim, "double3 xformOp:translate = ")) place = Vec3(take_numbers<3>(*told).data());
  StartMesh mesh;
  for (const auto& point : tuples<3>(points[chosen_frame(choice, times)]))
    mesh.nodes.emplace_back(place + Vec3(point.data()));
  std::vector<double> u;
  if (const auto told = after(prim, "texCoord2f[] primvars:st = ")) {
    for (const auto& st : tuples<2>(*told)) u.push_back(st[0]);
  }
  set_grid(mesh, u);
  return mesh;
}

}  // namespace weft::scene
