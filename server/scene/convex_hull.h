#pragma once
#include <vector>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::scene {

/// The surface of the convex hull of points, by Qhull (Barber, Dobkin, Huhdanpaa 1996), all triangles
/// counterclockwise as seen from outside. Points inside it are left out. Throws std::invalid_argument, saying
/// why, if there is none: fewer than 4 points, or all in a plane.
TriangleList convex_hull(const std::vector<Vec3>& points);

}  // namespace weft::scene
