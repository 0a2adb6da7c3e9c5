#pragma once
#include <vector>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::scene {

/// The surface that an outline of points (distance from the y axis, height; m) sweeps around that axis, in so
/// many steps. An outline whose first and last points are on the axis, and no others, is open: a bottle; one
/// with none there is closed by a line from the last to the first: a ring. Points of the first `sides` angle
/// lie at +x. Throws std::invalid_argument, saying what is wrong.
TriangleList lathe(const std::vector<Vec2>& outline, int sides);

}  // namespace weft::scene
