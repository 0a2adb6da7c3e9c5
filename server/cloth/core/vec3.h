#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace weft {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;  // metres, m/s, newtons: SI, right-handed, y up
using Quaternion = Eigen::Quaterniond;

/// Standard gravity's direction and size, m/s2.
inline Vec3 standard_gravity() { return {0.0, -9.81, 0.0}; }

/// What of it is across the unit vector.
inline Vec3 across(const Vec3& v, const Vec3& unit) { return v - v.dot(unit) * unit; }

/// The least turn that takes +y to where `direction` shows, which has any length above 0; where that is -y,
/// about +z. In place of Quaternion::FromTwoVectors, whose decomposition takes a compiler 10 s a file.
Quaternion turn_from_y(const Vec3& direction);

}  // namespace weft
