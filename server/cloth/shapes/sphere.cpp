#include <algorithm>
#include <cmath>

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/shape.h"

namespace weft {

Surface Sphere::nearest(const Vec3& point) const {
  const double length = point.norm();
  return {length - radius, length > 0 ? Vec3(point / length) : Vec3(0, 1, 0)};
}

bool Sphere::contains(const Vec3& point) const { return point.squaredNorm() < radius * radius; }

std::optional<Hit> Sphere::first_hit(const Vec3& from, const Vec3& way) const {
  // |from + t way| = radius, the smaller root, in the form that loses no digits when the way is long.
  const double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  if (!(b < 0) || !(discriminant >= 0)) return {};
  const double t = std::max(0.0, c / (-b + std::sqrt(discriminant)));
  if (!(t <= 1)) return {};
  return Hit{t, (from + t * way).normalized()};
}

double Sphere::way_out(const Vec3& origin, const Vec3& direction) const {
  const double along = origin.dot(direction);
  return -along + std::sqrt(std::max(0.0, along * along - origin.squaredNorm() + radius * radius));
}

Eigen::AlignedBox3d Sphere::bounds(const Vec3& centre, const Eigen::Matrix3d&) const {
  const Vec3 half = Vec3::Constant(radius);
  return {centre - half, centre + half};
}

double Sphere::inner_radius() const { return radius; }
double Sphere::bore() const { return radius; }
double Sphere::outer_radius() const { return radius; }

MassProperties Sphere::mass_properties() const {
  return {{0, 0, 0}, 0.4 * radius * radius * Eigen::Matrix3d::Identity()};
}

std::vector<Corner> Sphere::corners() const { return {{.radius = radius}}; }
std::vector<Face> Sphere::faces() const { return {}; }
bool Sphere::is_convex() const { return true; }

}  // namespace weft
