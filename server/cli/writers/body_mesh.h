#pragma once
/// What cloths meet, as triangles for files.
#include <cstdint>
#include <string>
#include <vector>

#include "cloth/shapes/shape.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft::cli {

/// In its own frame.
struct BodyMesh {
  std::string name;
  std::vector<float> positions, normals;  ///< x, y, z interleaved, m; normals are unit
  std::vector<std::uint32_t> triangles;   ///< counterclockwise as seen from outside
};

/// Balls and round ends have 32 segments around; a plane, which has no end, is a square of 20 m.
BodyMesh body_mesh(std::string name, const Shape& shape);
/// Of triangles, closed or not.
BodyMesh body_mesh(std::string name, const TriangleList& list);

}  // namespace weft::cli
