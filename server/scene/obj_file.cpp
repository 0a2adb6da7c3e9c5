#include "scene/obj_file.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "scene/beside_file.h"

namespace weft::scene {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

/// How many corners a line gives a face: the words after its "f"; 0 if it is another line.
std::size_t corners_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t";
  std::size_t words = 0;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != line.npos; ++words) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    if (words == 0 && line.substr(at, end - at) != "f") return 0;
    at = line.find_first_not_of(kBlanks, end);
  }
  return words > 0 ? words - 1 : 0;
}

/// Before the file is read: the time to cut a face into triangles grows faster than its corners, and a
/// triangle takes many times the memory of its line.
void check_faces(std::string_view text) {
  std::size_t number = 0, triangles = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(line.size());
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, text.size()));
    ++number;
    const std::size_t corners = corners_of(line);
    if (corners > kMaxFaceCorners) {
      refuse("has a face of " + std::to_string(corners) + " corners in line " + std::to_string(number) +
             "; at most " + std::to_string(kMaxFaceCorners) + " are allowed");
    }
    if (corners > 2) triangles += corners - 2;
  }
  if (triangles > kMaxObjTriangles) {
    refuse("has " + std::to_string(triangles) + " triangles; at most " + std::to_string(kMaxObjTriangles) +
           " are allowed in a file");
  }
}

}  // namespace

TriangleList parse_obj(const std::string& text) {
  check_faces(text);
  std::istringstream stream(text);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream)) {
    refuse("is not an OBJ file: " + error.substr(0, error.find('\n')));
  }
  TriangleList list;
  for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3) {
    list.vertices.emplace_back(attributes.vertices[i], attributes.vertices[i + 1],
                               attributes.vertices[i + 2]);
  }
  for (const tinyobj::shape_t& shape : shapes) {
    const std::vector<tinyobj::index_t>& corners = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      list.triangles.push_back(
          {corners[i].vertex_index, corners[i + 1].vertex_index, corners[i + 2].vertex_index});
    }
  }
  if (list.triangles.empty()) refuse("has no triangles: \"f\" lines of an OBJ file");
  return list;
}

TriangleList read_obj_file(const std::filesystem::path& folder, const std::string& file) {
  return parse_obj(read_beside(folder, file, kMaxObjBytes));
}

}  // namespace weft::scene
