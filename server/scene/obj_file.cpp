#include "scene/obj_file.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace weft::scene {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

/// The file's place, which no scene can make one outside its own folder.
fs::path place_of(const fs::path& folder, const std::string& file) {
  const fs::path relative(file);
  const bool upwards = std::find(relative.begin(), relative.end(), fs::path("..")) != relative.end();
  if (file.empty() || relative.is_absolute() || upwards) {
    refuse("must be a path within the scene file's folder, without \"..\"");
  }
  std::error_code error;
  const fs::path home = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  fs::path place = fs::canonical(home / relative, error);
  if (error) refuse("cannot be read: " + error.message());
  if (std::mismatch(home.begin(), home.end(), place.begin(), place.end()).first != home.end()) {
    refuse("is a link out of the scene file's folder");
  }
  if (!fs::is_regular_file(place, error)) refuse("is not a file");
  if (fs::file_size(place, error) > kMaxObjBytes) {
    refuse("has " + std::to_string(fs::file_size(place, error)) + " bytes; at most " +
           std::to_string(kMaxObjBytes) + " are allowed");
  }
  return place;
}

}  // namespace

TriangleList read_obj_file(const fs::path& folder, const std::string& file) {
  std::ifstream stream(place_of(folder, file), std::ios::binary);
  if (!stream) refuse(std::string("cannot be read: ") + std::strerror(errno));
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

}  // namespace weft::scene
