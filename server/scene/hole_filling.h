#pragma once
#include <cstddef>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::scene {

struct FilledSurface {
  TriangleList surface;
  int holes = 0;  ///< that were filled
};

/// Edges that one hole may have: the time to fill it grows with their cube.
inline constexpr std::size_t kMostHoleEdges = 1000;
/// All of a surface together take at most the time of so many with kMostHoleEdges.
inline constexpr std::size_t kMostLargestHoles = 4;

/// The surface with each of its borders, closed ways along edges that have one triangle, filled by triangles
/// between the border's vertices: ears are cut off in the plane that fits it best (Meisters, Polygons Have
/// Ears, 1975). A border that crosses itself there is filled by triangles about its middle. Vertices in one
/// place are one. Throws std::invalid_argument, saying what is wrong and where, as TriangleMesh does, and
/// where a hole has more edges than kMostHoleEdges or all are more than kMostLargestHoles allow, or the
/// filled surface encloses nothing, as that of a flat sheet.
FilledSurface fill_holes(const TriangleList& list);

}  // namespace weft::scene
