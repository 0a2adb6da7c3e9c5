#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "cloth/shapes/triangle.h"

namespace weft {

/// Cells around a surface, the finer the nearer to it, each with the few triangles that can be nearest to
/// some point in it: what is nearest to a point beside the surface is found by its cell, exactly, at the cost
/// of these few. (A closest-point query of FCL takes 10 to 20 microseconds, a hundred times as long; a baked
/// grid of distances would round off edges.)
class TriangleOctree {
 public:
  /// Where a cell lies, if no surface runs through it.
  enum class Side : std::int8_t { crossed, inside, outside };
  struct Cell {
    std::int32_t children = -1;          ///< the first of 8; -1: none, and the rest is valid
    std::uint32_t begin = 0, count = 0;  ///< its triangles in indices_; none if the surface keeps off
    float clearance = 0;                 ///< no point in it is nearer to the surface, m
    Side side = Side::outside;
    /// What is below the planes of all its triangles is inside: each of them lies below all these planes, and
    /// no two face away from each other.
    bool convex = false;
  };
  struct Nearest {
    std::size_t triangle = 0;
    NearestOnTriangle found;
    double square = std::numeric_limits<double>::infinity();  ///< of the distance, m2
  };

  /// `convex`: the surface is a convex body's. `inside(point, nearest)` tells on which side of the surface a
  /// point is. Keeps a reference to `triangles`, which must not be empty.
  TriangleOctree(const std::vector<Triangle>& triangles, bool convex,
                 const std::function<bool(const Vec3&, const Nearest&)>& inside);

  /// The cell around a point, or nullptr beyond all of them: outside then.
  const Cell* cell_at(const Vec3& point) const;
  /// No point at `point` is nearer to the surface, m.
  double clearance(const Vec3& point, const Cell* cell) const;
  /// The triangle nearest to a point, of equally near ones any.
  Nearest nearest(const Vec3& point, const Cell* cell) const;
  /// A point's cell is convex: it is inside. At a fifth of the cost of what is nearest.
  bool is_below_all(const Vec3& point, const Cell& cell) const {
    return std::all_of(indices_.begin() + cell.begin, indices_.begin() + cell.begin + cell.count,
                       [&](std::uint32_t i) { return height_over(triangles_[i], point) < 0; });
  }
  /// Calls visit(triangle) for all triangles near a straight way, some of them several times.
  template <class Visit>
  void for_each_along(const Vec3& from, const Vec3& to, Visit visit) const;

  std::size_t bytes() const {
    return cells_.capacity() * sizeof(Cell) + indices_.capacity() * sizeof(indices_[0]) +
           balls_.capacity() * sizeof(Ball);
  }

 private:
  struct Place {
    Vec3 centre;
    double half;  ///< of an edge
  };
  struct Candidates {
    std::vector<std::uint32_t> triangles;
    Nearest nearest;  ///< to the centre
  };
  using Inside = std::function<bool(const Vec3&, const Nearest&)>;
  Candidates candidates_of(const Place& place, const std::vector<std::uint32_t>& parents) const;
  void build(std::size_t cell, const Place& place, int depth, const Candidates& candidates,
             const Inside& inside);
  bool are_convex(const std::vector<std::uint32_t>& candidates) const;
  void consider(const Cell& cell, const Vec3& point, Nearest& best) const;
  void search(const Cell& cell, const Place& place, const Vec3& point, Nearest& best) const;
  template <class Visit>
  void walk(const Cell& cell, const Place& place, const Vec3& from, const Vec3& way, Visit& visit) const;

  const Cell& child_cell(const Cell& parent, int child) const {
    return cells_[static_cast<std::size_t>(parent.children) + static_cast<std::size_t>(child)];
  }
  static Place child_of(const Place& place, int child) {
    const double half = place.half / 2;
    return {place.centre + Vec3((child & 1) != 0 ? half : -half, (child & 2) != 0 ? half : -half,
                                (child & 4) != 0 ? half : -half),
            half};
  }
  static int child_with(const Place& place, const Vec3& point) {
    return (point.x() >= place.centre.x() ? 1 : 0) | (point.y() >= place.centre.y() ? 2 : 0) |
           (point.z() >= place.centre.z() ? 4 : 0);
  }
  static bool crosses(const Place& place, const Vec3& from, const Vec3& way);
  static double height_over(const Triangle& triangle, const Vec3& point) {
    return triangle.normal.dot(point - triangle.corner[0]);
  }
  bool holds(const Vec3& point) const {
    return ((point - root_.centre).cwiseAbs().array() <= root_.half).all();
  }

  /// Around a triangle, somewhat larger than needed: most candidates are seen to be too far by it.
  struct Ball {
    float x, y, z, radius;
  };
  static Ball ball_around(const Triangle& triangle);

  const std::vector<Triangle>& triangles_;
  bool convex_;
  std::vector<Ball> balls_;
  Place root_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> indices_;
};

template <class Visit>
void TriangleOctree::for_each_along(const Vec3& from, const Vec3& to, Visit visit) const {
  const Cell* cell = cells_.data();
  Place place = root_;
  if (holds(from) && holds(to)) {  // most ways are short: down to the smallest cell that holds all of it
    while (cell->children >= 0) {
      const int child = child_with(place, from);
      if (child_with(place, to) != child) break;
      cell = &child_cell(*cell, child);
      place = child_of(place, child);
    }
  }
  walk(*cell, place, from, to - from, visit);
}

template <class Visit>
void TriangleOctree::walk(const Cell& cell, const Place& place, const Vec3& from, const Vec3& way,
                          Visit& visit) const {
  if (!crosses(place, from, way)) return;
  if (cell.children < 0) {
    if (cell.side != Side::crossed) return;
    for (std::size_t i = cell.begin; i < cell.begin + cell.count; ++i) visit(indices_[i]);
    return;
  }
  for (int child = 0; child < 8; ++child) {
    walk(child_cell(cell, child), child_of(place, child), from, way, visit);
  }
}

}  // namespace weft
