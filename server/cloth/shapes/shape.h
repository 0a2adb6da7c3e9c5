#pragma once
#include <optional>
#include <variant>
#include <vector>

#include "cloth/core/vec3.h"

namespace weft {

class TriangleMesh;

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

/// A corner of a shape in its own frame, or the centre of a round one.
struct Corner {
  Vec3 place{0, 0, 0};     ///< m
  double radius = 0;       ///< of what is round about it, m
  Vec3 outwards{0, 0, 0};  ///< unit, of a sharp one
};

/// A flat face of a shape in its own frame.
struct Face {
  Vec3 normal{0, 1, 0};  ///< unit, outwards
  double height = 0;     ///< of its plane over the origin along the normal, m
};

struct MassProperties;

// Each shape's members are in a file of its name, and say in its own frame what the functions below ask of
// any shape: a new shape is one struct, its file and an alternative of Shape.

/// Centred at the origin of its own frame.
struct Sphere {
  double radius = 0;  ///< m

  Surface nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& way) const;
  double way_out(const Vec3& origin, const Vec3& direction) const;
  Eigen::AlignedBox3d bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const;
  double inner_radius() const;
  double bore() const;
  double outer_radius() const;
  MassProperties mass_properties() const;
  std::vector<Corner> corners() const;
  std::vector<Face> faces() const;
  bool is_convex() const;
};
/// All below y = 0 of its own frame.
struct HalfSpace {
  Surface nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& way) const;
  double way_out(const Vec3& origin, const Vec3& direction) const;
  Eigen::AlignedBox3d bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const;
  double inner_radius() const;
  double bore() const;
  double outer_radius() const;
  MassProperties mass_properties() const;
  std::vector<Corner> corners() const;
  std::vector<Face> faces() const;
  bool is_convex() const;
};
/// Centred, edges along its own axes.
struct Box {
  Vec3 half{0, 0, 0};  ///< half the lengths of its edges, m

  Surface nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& way) const;
  double way_out(const Vec3& origin, const Vec3& direction) const;
  Eigen::AlignedBox3d bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const;
  double inner_radius() const;
  double bore() const;
  double outer_radius() const;
  MassProperties mass_properties() const;
  std::vector<Corner> corners() const;
  std::vector<Face> faces() const;
  bool is_convex() const;
};
/// All within `radius` of the middle stretch of its own y axis; a limb.
struct Capsule {
  double half = 0;    ///< half the stretch's length, m
  double radius = 0;  ///< m

  Surface nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& way) const;
  double way_out(const Vec3& origin, const Vec3& direction) const;
  Eigen::AlignedBox3d bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const;
  double inner_radius() const;
  double bore() const;
  double outer_radius() const;
  MassProperties mass_properties() const;
  std::vector<Corner> corners() const;
  std::vector<Face> faces() const;
  bool is_convex() const;
};
/// Within a closed surface of triangles. It belongs to someone else, who keeps it: shapes are copied in hot
/// loops.
struct Mesh {
  const TriangleMesh* surface = nullptr;

  Surface nearest(const Vec3& point) const;
  bool contains(const Vec3& point) const;
  std::optional<Hit> first_hit(const Vec3& from, const Vec3& way) const;
  double way_out(const Vec3& origin, const Vec3& direction) const;
  Eigen::AlignedBox3d bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const;
  double inner_radius() const;
  double bore() const;
  double outer_radius() const;
  MassProperties mass_properties() const;
  std::vector<Corner> corners() const;
  std::vector<Face> faces() const;
  bool is_convex() const;
};
using Shape = std::variant<Sphere, HalfSpace, Box, Capsule, Mesh>;

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

/// The shape's corners, of which it is the convex hull unless it is a mesh that is not convex. A half-space
/// has none.
std::vector<Corner> corners_of(const Shape& shape);
/// Its flat faces; none of a mesh that is not known to be convex.
std::vector<Face> faces_of(const Shape& shape);
/// Neither a half-space nor a mesh that is not known to be convex.
bool is_convex(const Shape& shape);

}  // namespace weft
