#pragma once
#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cloth/shapes/triangle_mesh.h"

namespace weft {

/// "[x, y, z]"
std::string place_text(const Vec3& place);

/// The surface has a border.
class OpenSurface : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Vertices in one place become one; those of no triangle are left out. Throws std::invalid_argument where a
/// triangle has corners that there are not, or a vertex is not finite.
TriangleList welded(const TriangleList& list);

/// Edges that have one triangle, in its direction. Throws std::invalid_argument where two triangles pass an
/// edge in the same direction.
std::vector<std::pair<int, int>> open_edges(const TriangleList& surface);

/// Above 0 if the triangles of the closed surface are counterclockwise as seen from outside, m3.
double enclosed_volume(const TriangleList& surface);

/// The surface as TriangleMesh takes it, or its exception; OpenSurface if it is not closed.
TriangleList closed_surface(const TriangleList& list);

/// Of a closed surface, of each triangle: the triangles beyond its edges, from corner 0, 1 and 2 to the next.
std::vector<std::array<int, 3>> edge_neighbours(const TriangleList& surface);

}  // namespace weft
