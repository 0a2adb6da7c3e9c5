#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/shape.h"

namespace weft {

Surface Box::nearest(const Vec3& point) const {
  const Vec3 beyond = point.cwiseAbs() - half;
  const Vec3 sign = point.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
  int axis = 0;
  const double deepest = beyond.maxCoeff(&axis);
  if (deepest <= 0) return {deepest, Vec3(sign[axis] * Vec3::Unit(axis))};
  const Vec3 outside = beyond.cwiseMax(0.0);
  const double distance = outside.norm();
  return {distance, Vec3(outside.cwiseProduct(sign) / distance)};
}

bool Box::contains(const Vec3& point) const { return (point.cwiseAbs() - half).maxCoeff() < 0; }

std::optional<Hit> Box::first_hit(const Vec3& from, const Vec3& way) const {
  // Slabs (Kay and Kajiya 1986).
  double enter = 0, leave = 1;
  Vec3 normal = nearest(from).normal;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (std::abs(from[axis]) > half[axis]) return {};
      continue;
    }
    const double side = way[axis] > 0 ? 1.0 : -1.0;
    const double in = (-side * half[axis] - from[axis]) / way[axis];
    if (in > enter) {
      enter = in;
      normal = -side * Vec3::Unit(axis);
    }
    leave = std::min(leave, (side * half[axis] - from[axis]) / way[axis]);
  }
  if (!(enter <= leave)) return {};
  return Hit{enter, normal};
}

double Box::way_out(const Vec3& origin, const Vec3& direction) const {
  double out = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double side = direction[axis] > 0 ? 1.0 : -1.0;
    out = std::min(out, (side * half[axis] - origin[axis]) / direction[axis]);
  }
  return std::max(0.0, out);
}

Eigen::AlignedBox3d Box::bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const {
  const Vec3 reach = rotation.cwiseAbs() * half;
  return {centre - reach, centre + reach};
}

double Box::inner_radius() const { return half.minCoeff(); }
double Box::outer_radius() const { return half.norm(); }

double Box::bore() const {
  Vec3 sides = half;
  std::sort(sides.begin(), sides.end());
  return std::hypot(sides[0], sides[1]);
}
MassProperties Box::mass_properties() const {
  const Vec3 moment = half.cwiseAbs2() / 3;
  return {{0, 0, 0}, inertia_of(Eigen::Matrix3d(moment.asDiagonal()))};
}

std::vector<Face> Box::faces() const {
  std::vector<Face> all;
  for (const int axis : {0, 1, 2}) {
    for (const double side : {1.0, -1.0}) all.push_back({side * Vec3::Unit(axis), half[axis]});
  }
  return all;
}

std::vector<Corner> Box::corners() const {
  std::vector<Corner> all;
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) {
      for (const double z : {-1, 1}) {
        const Vec3 side(x, y, z);
        all.push_back({.place = half.cwiseProduct(side), .outwards = side.normalized()});
      }
    }
  }
  return all;
}

bool Box::is_convex() const { return true; }

}  // namespace weft
