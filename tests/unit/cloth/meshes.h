#pragma once
#include <cmath>
#include <numbers>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::test {

/// Two triangles a face.
inline TriangleList box_mesh(const Vec3& half) {
  TriangleList box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.push_back(
        half.cwiseProduct(Vec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
  }
  box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return box;
}

/// place(u, v) on a grid that closes in v (0 to 1, `sectors` cells) and, if `ring`, in u (`rows` cells); else
/// the rows at u = 0 and 1 are single points.
template <class Place>
TriangleList revolved(int rows, int sectors, bool ring, Place place) {
  TriangleList mesh;
  const int nodes = ring ? rows : rows + 1;
  for (int r = 0; r < nodes; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const bool pole = !ring && (r == 0 || r == rows);
      mesh.vertices.push_back(place(double(r) / rows, pole ? 0.0 : double(s) / sectors));
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const int below = r * sectors, above = (r + 1) % nodes * sectors, next = (s + 1) % sectors;
      mesh.triangles.push_back({below + s, above + s, above + next});
      mesh.triangles.push_back({below + s, above + next, below + next});
    }
  }
  return mesh;
}

/// Its vertices lie on the sphere: 2 sectors (rows - 1) triangles.
inline TriangleList sphere_mesh(double radius, int rows, int sectors) {
  return revolved(rows, sectors, false, [&](double u, double v) {
    const double down = std::numbers::pi * u, round = 2 * std::numbers::pi * v;
    if (u == 0 || u == 1) return Vec3(0, u == 0 ? radius : -radius, 0);  // exactly one point
    return Vec3(radius * std::sin(down) * std::cos(round), radius * std::cos(down),
                radius * std::sin(down) * std::sin(round));
  });
}

/// Around the y axis.
inline TriangleList torus_mesh(double radius, double tube, int rows, int sectors) {
  return revolved(rows, sectors, true, [&](double u, double v) {
    const double across = 2 * std::numbers::pi * u, round = 2 * std::numbers::pi * v;
    const double out = radius + tube * std::cos(across);
    return Vec3(out * std::cos(round), tube * std::sin(across), out * std::sin(round));
  });
}

}  // namespace weft::test
