#pragma once
#include "cloth/shapes/shape.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {

/// Of a body of uniform density, per kg of its mass.
struct MassProperties {
  Vec3 centre{0, 0, 0};     ///< of mass, in the shape's own frame, m
  Eigen::Matrix3d inertia;  ///< about that centre, along the shape's own axes, m2
};

/// Inertia per kg, m2, from the mean of x x^T over the mass, m2.
Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moment);

/// The moments about its principal axes, ascending.
Vec3 principal_moments(const Eigen::Matrix3d& inertia);

/// Sphere, box and capsule in closed form, a mesh as below. Throws std::invalid_argument of a half-space,
/// which has no end, and as below.
MassProperties mass_properties(const Shape& shape);

/// Of what is within a closed surface: the sum over the tetrahedra between the origin and each triangle,
/// negative where that faces the origin (Tonon, Explicit exact formulas for the 3-D tetrahedron inertia
/// tensor in terms of its vertex coordinates, 2004). Throws std::invalid_argument if it is so thin that
/// rounding leaves no volume or no inertia.
MassProperties mass_properties(const TriangleList& surface);

}  // namespace weft
