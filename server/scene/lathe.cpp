#include "scene/lathe.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace weft::scene {

TriangleList lathe(const std::vector<Vec2>& outline, int sides) {
  const std::size_t count = outline.size();
  const bool open = outline.front().x() == 0 && outline.back().x() == 0;
  for (std::size_t i = open ? 1 : 0; i < (open ? count - 1 : count); ++i) {
    if (outline[i].x() > 0) continue;
    throw std::invalid_argument(
        "must have its first and its last point on the axis, at distance 0, and no others, or none");
  }
  TriangleList surface;
  std::vector<int> first;  // vertex of each point, at +x
  for (std::size_t i = 0; i < count; ++i) {
    first.push_back(static_cast<int>(surface.vertices.size()));
    const bool on_axis = outline[i].x() == 0;
    for (int side = 0; side < (on_axis ? 1 : sides); ++side) {
      const double angle = 2 * std::numbers::pi * side / sides;
      surface.vertices.emplace_back(outline[i].x() * std::cos(angle), outline[i].y(),
                                    -outline[i].x() * std::sin(angle));
    }
  }
  const auto vertex = [&](std::size_t i, int side) {
    return first[i] + (outline[i].x() == 0 ? 0 : side % sides);
  };
  for (std::size_t i = 0; i < (open ? count - 1 : count); ++i) {
    const std::size_t next = (i + 1) % count;
    for (int side = 0; side < sides; ++side) {
      const int a = vertex(i, side), b = vertex(i, side + 1), c = vertex(next, side + 1),
                d = vertex(next, side);
      if (a != b) surface.triangles.push_back({a, b, c});
      if (c != d) surface.triangles.push_back({a, c, d});
    }
  }
  return surface;
}

}  // namespace weft::scene
