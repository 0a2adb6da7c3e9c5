#include <algorithm>
#include <cmath>

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/shape.h"

namespace weft {
namespace {

/// The larger root of |origin + t direction| = radius; none if the line misses.
std::optional<double> far_root(const Vec3& origin, const Vec3& direction, double radius) {
  const double a = direction.squaredNorm(), b = origin.dot(direction);
  const double discriminant = b * b - a * (origin.squaredNorm() - radius * radius);
  if (!(a > 0) || !(discriminant >= 0)) return {};
  return (-b + std::sqrt(discriminant)) / a;
}

}  // namespace

Surface Capsule::nearest(const Vec3& point) const {
  const Vec3 across = point - Vec3(0, std::clamp(point.y(), -half, half), 0);
  const double length = across.norm();
  return {length - radius, length > 0 ? Vec3(across / length) : Vec3(1, 0, 0)};
}

bool Capsule::contains(const Vec3& point) const {
  return (point - Vec3(0, std::clamp(point.y(), -half, half), 0)).squaredNorm() < radius * radius;
}

std::optional<Hit> Capsule::first_hit(const Vec3& from, const Vec3& way) const {
  // The first of: its two ends, as spheres; its side, as a circle across the axis.
  const Sphere end{radius};
  std::optional<Hit> first;
  const auto take = [&](const std::optional<Hit>& hit) {
    if (hit && (!first || hit->fraction < first->fraction)) first = hit;
  };
  for (const double y : {-half, half}) take(end.first_hit(from - Vec3(0, y, 0), way));
  const Vec3 flat(1, 0, 1);
  const std::optional<Hit> side = end.first_hit(from.cwiseProduct(flat), way.cwiseProduct(flat));
  if (side && std::abs(from.y() + side->fraction * way.y()) <= half) take(side);
  return first;
}

double Capsule::way_out(const Vec3& origin, const Vec3& direction) const {
  // The last point of the ray in any of its three parts: it is convex.
  double out = 0;
  for (const double y : {-half, half}) {
    out = std::max(out, far_root(origin - Vec3(0, y, 0), direction, radius).value_or(0));
  }
  const Vec3 flat(1, 0, 1);
  const auto side = far_root(origin.cwiseProduct(flat), direction.cwiseProduct(flat), radius);
  if (side && std::abs(origin.y() + *side * direction.y()) <= half) out = std::max(out, *side);
  return out;
}

Eigen::AlignedBox3d Capsule::bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const {
  const Vec3 reach = rotation.col(1).cwiseAbs() * half + Vec3::Constant(radius);
  return {centre - reach, centre + reach};
}

double Capsule::inner_radius() const { return radius; }
double Capsule::bore() const { return radius; }
double Capsule::outer_radius() const { return half + radius; }

/// A cylinder of length 2 h and two half balls of radius r, by their volumes, and Steiner's theorem for
/// these, whose own centres are 3/8 r from the flat side.
MassProperties Capsule::mass_properties() const {
  const double h = half, r = radius;
  const double cylinder = 2 * h, ball = 4 * r / 3;  // volumes / (pi r^2)
  const double share = cylinder / (cylinder + ball);
  const double along = share * r * r / 2 + (1 - share) * 2 * r * r / 5;
  const double across =
      share * (r * r / 4 + h * h / 3) + (1 - share) * (2 * r * r / 5 + h * h + 3 * h * r / 4);
  return {{0, 0, 0}, Vec3(across, along, across).asDiagonal()};
}

std::vector<Face> Capsule::faces() const { return {}; }

std::vector<Corner> Capsule::corners() const {
  return {{.place = {0, -half, 0}, .radius = radius}, {.place = {0, half, 0}, .radius = radius}};
}

bool Capsule::is_convex() const { return true; }

}  // namespace weft
