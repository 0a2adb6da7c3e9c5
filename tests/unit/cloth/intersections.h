#pragma once
#include <array>
#include <vector>

#include "cloth/core/particles.h"

namespace weft::test {

/// A triangle of a scene: three nodes of the points it is counted among.
struct Triangle {
  std::array<std::size_t, 3> node;
};

/// Triangles with their corners, as drawn: two a cell, split from top left to bottom right.
struct TriangleSoup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;

  template <class Real>
  void add(const Particles<Real>& particles) {
    const Grid& grid = particles.grid();
    const std::size_t first = points.size(), cols = static_cast<std::size_t>(grid.cols);
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) points.push_back(particles.position_at(r, c));
    }
    for (std::size_t r = 0; r + 1 < static_cast<std::size_t>(grid.rows); ++r) {
      for (std::size_t c = 0; c + 1 < cols; ++c) {
        const std::size_t top = first + r * cols + c, bottom = top + cols;
        triangles.push_back({{top, bottom, bottom + 1}});
        triangles.push_back({{top, bottom + 1, top + 1}});
      }
    }
  }
};

/// True if p and q lie strictly on different sides of the triangle's plane and the segment between them meets
/// the triangle. Decided exactly: signs of determinants in double precision where its rounding cannot matter,
/// else in rational numbers.
bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Pairs of triangles of which an edge of one crosses the other without having a corner in common with it.
int count_intersections(const TriangleSoup& soup);

}  // namespace weft::test
