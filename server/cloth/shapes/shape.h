#pragma once
#include <optional>
#include <variant>

#include "cloth/core/vec3.h"

namespace weft {

class TriangleMesh;

/// Centred at the origin of its own frame.
struct Sphere {
  double radius = 0;  ///< m
};
/// All below y = 0 of its own frame.
struct HalfSpace {};
/// Centred, edges along its own axes.
struct Box {
  Vec3 half{0, 0, 0};  ///< half the lengths of its edges, m
};
/// All within `radius` of the middle stretch of its own y axis; a limb.
struct Capsule {
  double half = 0;    ///< half the stretch's length, m
  double radius = 0;  ///< m
};
/// Within a closed surface of triangles. It belongs to someone else, who keeps it: shapes are copied in hot
/// loops.
struct Mesh {
  const TriangleMesh* surface = nullptr;
};
using Shape = std::variant<Sphere, HalfSpace, Box, Capsule, Mesh>;

/// The point of a surface next to some point.
struct Surface {
  double distance = 0;   ///< to the surface, m; negative inside
  Vec3 normal{0, 1, 0};  ///< unit, outwards: the point lies at surface point + distance * normal
};

/// Where a way first meets a surface.
struct Hit {
  double fraction = 0;  ///< of the way
  Vec3 normal{0, 1, 0};
};

/// A shape where it is at some time.
struct PlacedShape {
  Shape shape;
  Vec3 centre{0, 0, 0};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< its own axes in the world

  /// At a sphere's very centre the normal points upwards, on a capsule's axis across it; deep in a box
  /// towards the nearest face.
  Surface surface(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  /// Where the straight way from `from`, outside, to `to` first enters; none if it never does.
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& to) const;
  /// Where the ray from `origin`, inside, leaves: the distance along the unit `direction`.
  double way_out(const Vec3& origin, const Vec3& direction) const;
  /// False only if it is outside and `reach`, m, or farther from the surface, and that is seen at one look.
  bool may_touch(const Vec3& point, double reach) const;
  /// Infinite for a half-space; of a turned mesh those of the box around it in its own frame.
  Eigen::AlignedBox3d bounds() const;
};

/// Half of the shape's smallest width, m: a node that moves much less in a substep cannot pass through.
double inner_radius(const Shape& shape);
/// Radius of the smallest round hole that the shape fits through, m; infinite for a half-space; of a mesh the
/// box's around it in its own frame.
double bore(const Shape& shape);
/// Of the smallest ball around its centre that holds it, m. Infinite for a half-space.
double outer_radius(const Shape& shape);

}  // namespace weft
