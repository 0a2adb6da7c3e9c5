#include <algorithm>
#include <limits>
#include <stdexcept>

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/shape.h"

namespace weft {

Surface HalfSpace::nearest(const Vec3& point) const { return {point.y(), Vec3(0, 1, 0)}; }

bool HalfSpace::contains(const Vec3& point) const { return point.y() < 0; }

std::optional<Hit> HalfSpace::first_hit(const Vec3& from, const Vec3& way) const {
  if (!(way.y() < 0) || !(from.y() + way.y() <= 0)) return {};
  return Hit{std::max(0.0, from.y() / -way.y()), Vec3(0, 1, 0)};
}

double HalfSpace::way_out(const Vec3& origin, const Vec3& direction) const {
  return direction.y() > 0 ? std::max(0.0, -origin.y() / direction.y())
                           : std::numeric_limits<double>::infinity();
}

Eigen::AlignedBox3d HalfSpace::bounds(const Vec3& centre, const Eigen::Matrix3d&) const {
  const Vec3 half = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {centre - half, centre + half};
}

double HalfSpace::inner_radius() const { return std::numeric_limits<double>::infinity(); }
double HalfSpace::bore() const { return std::numeric_limits<double>::infinity(); }
double HalfSpace::outer_radius() const { return std::numeric_limits<double>::infinity(); }

MassProperties HalfSpace::mass_properties() const {
  throw std::invalid_argument("has no end, and so no mass");
}

std::vector<Corner> HalfSpace::corners() const { return {}; }
std::vector<Face> HalfSpace::faces() const { return {Face{}}; }
bool HalfSpace::is_convex() const { return false; }

}  // namespace weft
