#pragma once
#include <array>
#include <vector>

#include "cloth/shapes/triangle_mesh.h"

namespace weft {

/// The surface as TriangleMesh takes it, or its exception.
TriangleList closed_surface(const TriangleList& list);

/// Of a closed surface, of each triangle: the triangles beyond its edges, from corner 0, 1 and 2 to the next.
std::vector<std::array<int, 3>> edge_neighbours(const TriangleList& surface);

}  // namespace weft
