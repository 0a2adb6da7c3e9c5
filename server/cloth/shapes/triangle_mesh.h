#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cloth/shapes/shape.h"
#include "cloth/shapes/triangle_octree.h"

namespace weft {

/// A surface as files have it: each triangle three of the vertices, counted from 0.
struct TriangleList {
  std::vector<Vec3> vertices;  ///< m
  std::vector<std::array<int, 3>> triangles;
  bool convex = false;  ///< known to be the surface of a convex body
};

/// A solid within a closed surface of triangles, in its own frame. Distances are exact; on which side of the
/// surface a point is, is told by the normal of what of it is nearest: the face's, the mean of an edge's two
/// faces' or the mean by angle of a corner's (Baerentzen and Aanaes, Signed distance computation using the
/// angle weighted pseudonormal, 2005). Nodes of a cloth are kept out; where its cells are larger than what
/// sticks out of the surface, that reaches through them.
class TriangleMesh {
 public:
  /// Triangles that a file may well have but that say nothing are left out: two of their corners in one
  /// place. Vertices in one place are one. If the surface encloses a negative volume it is turned inside out:
  /// its triangles were clockwise.
  /// Throws std::invalid_argument, saying what is wrong and where, unless all vertices are finite, all
  /// triangles have existing corners and an area, and each edge belongs to two triangles that pass it in
  /// opposite directions: the surface has no border and no third face at an edge.
  explicit TriangleMesh(const TriangleList& list);
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  /// The surface as it is taken: without what was left out, counterclockwise as seen from outside.
  const TriangleList& list() const { return list_; }
  /// Of a convex body, the flat faces that its triangles make up; none of another.
  const std::vector<Face>& faces() const { return faces_; }

  struct Nearest {
    double distance = 0;   ///< to the surface, m; negative inside
    Vec3 normal{0, 1, 0};  ///< unit, outwards
  };
  Nearest nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  /// True unless it is sure, at one look, that the point is outside and `reach`, m, or farther from the
  /// surface.
  bool may_touch(const Vec3& point, double reach) const;

  struct Crossing {
    double fraction = 0;  ///< of the way
    Vec3 normal{0, 1, 0};
  };
  /// Where the straight way from `from`, outside, first enters; none if it does not.
  std::optional<Crossing> first_entry(const Vec3& from, const Vec3& way) const;
  /// Where the ray from `origin`, inside, first leaves: the distance along the unit `direction`, m.
  double way_out(const Vec3& origin, const Vec3& direction) const;

  const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  double outer_radius() const { return outer_radius_; }  ///< of all vertices, from the origin, m
  /// Half of the shortest way straight in from a triangle's middle and out again, m: what is thinner between
  /// triangles' middles, near sharp edges, it does not see.
  double inner_radius() const { return inner_radius_; }
  std::size_t bytes() const;  ///< of memory

 private:
  /// Of one triangle's edges and corners, as Feature counts: the outward pseudonormals, of any length.
  using Pseudonormals = std::array<Vec3, 6>;
  double side_of(const Vec3& point, const TriangleOctree::Nearest& nearest) const;
  const Vec3& normal_of(const TriangleOctree::Nearest& nearest) const;

  TriangleList list_;
  std::vector<Triangle> triangles_;
  std::vector<Pseudonormals> pseudonormals_;
  std::vector<Face> faces_;
  Eigen::AlignedBox3d bounds_;
  double outer_radius_ = 0, inner_radius_ = 0;
  std::optional<TriangleOctree> cells_;
};

}  // namespace weft
