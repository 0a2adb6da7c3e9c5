#pragma once
#include <filesystem>
#include <string>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::scene {

inline constexpr std::size_t kMaxObjBytes = 64u << 20;
inline constexpr std::size_t kMaxFaceCorners = 128;
inline constexpr std::size_t kMaxObjTriangles = 1'000'000;

/// The surface in the text of a Wavefront OBJ file: its vertices and faces, of all objects and groups; faces
/// of more than three corners, at most kMaxFaceCorners, are cut into triangles. Throws std::invalid_argument,
/// saying what is wrong.
TriangleList parse_obj(const std::string& text);

/// That of the file itself, which is looked for in `folder`, the scene file's, and must stay in it: a
/// relative path without "..", and no link out of it. Throws as parse_obj.
TriangleList read_obj_file(const std::filesystem::path& folder, const std::string& file);

}  // namespace weft::scene
