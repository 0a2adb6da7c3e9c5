#include "cloth/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/shapes/triangle_mesh.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// All in the shape's own frame.

Surface surface_of(const Sphere& sphere, const Vec3& point) {
  const double length = point.norm();
  return {length - sphere.radius, length > 0 ? Vec3(point / length) : Vec3(0, 1, 0)};
}

Surface surface_of(const HalfSpace&, const Vec3& point) { return {point.y(), Vec3(0, 1, 0)}; }

Surface surface_of(const Box& box, const Vec3& point) {
  const Vec3 beyond = point.cwiseAbs() - box.half;
  const Vec3 sign = point.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
  int axis = 0;
  const double deepest = beyond.maxCoeff(&axis);
  if (deepest <= 0) return {deepest, Vec3(sign[axis] * Vec3::Unit(axis))};
  const Vec3 outside = beyond.cwiseMax(0.0);
  const double distance = outside.norm();
  return {distance, Vec3(outside.cwiseProduct(sign) / distance)};
}

/// The axis' nearest point.
Vec3 on_axis(const Capsule& capsule, const Vec3& point) {
  return {0, std::clamp(point.y(), -capsule.half, capsule.half), 0};
}

Surface surface_of(const Capsule& capsule, const Vec3& point) {
  const Vec3 across = point - on_axis(capsule, point);
  const double length = across.norm();
  return {length - capsule.radius, length > 0 ? Vec3(across / length) : Vec3(1, 0, 0)};
}

Surface surface_of(const Mesh& mesh, const Vec3& point) {
  const TriangleMesh::Nearest nearest = mesh.surface->nearest(point);
  return {nearest.distance, nearest.normal};
}

std::optional<Hit> hit_of(const Sphere& sphere, const Vec3& from, const Vec3& way) {
  // |from + t way| = radius, the smaller root, in the form that loses no digits when the way is long.
  const double a = way.squaredNorm(), b = from.dot(way),
               c = from.squaredNorm() - sphere.radius * sphere.radius;
  const double discriminant = b * b - a * c;
  if (!(b < 0) || !(discriminant >= 0)) return {};
  const double t = std::max(0.0, c / (-b + std::sqrt(discriminant)));
  if (!(t <= 1)) return {};
  return Hit{t, (from + t * way).normalized()};
}

std::optional<Hit> hit_of(const HalfSpace&, const Vec3& from, const Vec3& way) {
  if (!(way.y() < 0) || !(from.y() + way.y() <= 0)) return {};
  return Hit{std::max(0.0, from.y() / -way.y()), Vec3(0, 1, 0)};
}

std::optional<Hit> hit_of(const Box& box, const Vec3& from, const Vec3& way) {
  // Slabs (Kay and Kajiya 1986).
  double enter = 0, leave = 1;
  Vec3 normal = surface_of(box, from).normal;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (std::abs(from[axis]) > box.half[axis]) return {};
      continue;
    }
    const double side = way[axis] > 0 ? 1.0 : -1.0;
    const double in = (-side * box.half[axis] - from[axis]) / way[axis];
    if (in > enter) {
      enter = in;
      normal = -side * Vec3::Unit(axis);
    }
    leave = std::min(leave, (side * box.half[axis] - from[axis]) / way[axis]);
  }
  if (!(enter <= leave)) return {};
  return Hit{enter, normal};
}

std::optional<Hit> hit_of(const Capsule& capsule, const Vec3& from, const Vec3& way) {
  // The first of: its two ends, as spheres; its side, as a circle across the axis.
  const Sphere end{capsule.radius};
  std::optional<Hit> first;
  const auto take = [&](const std::optional<Hit>& hit) {
    if (hit && (!first || hit->fraction < first->fraction)) first = hit;
  };
  for (const double y : {-capsule.half, capsule.half}) take(hit_of(end, from - Vec3(0, y, 0), way));
  const Vec3 flat(1, 0, 1);
  const std::optional<Hit> side = hit_of(end, from.cwiseProduct(flat), way.cwiseProduct(flat));
  if (side && std::abs(from.y() + side->fraction * way.y()) <= capsule.half) take(side);
  return first;
}

std::optional<Hit> hit_of(const Mesh& mesh, const Vec3& from, const Vec3& way) {
  const std::optional<TriangleMesh::Crossing> entry = mesh.surface->first_entry(from, way);
  return entry ? std::optional<Hit>({entry->fraction, entry->normal}) : std::nullopt;
}

double way_out_of(const Sphere& sphere, const Vec3& origin, const Vec3& direction) {
  const double along = origin.dot(direction);
  return -along +
         std::sqrt(std::max(0.0, along * along - origin.squaredNorm() + sphere.radius * sphere.radius));
}

double way_out_of(const HalfSpace&, const Vec3& origin, const Vec3& direction) {
  return direction.y() > 0 ? std::max(0.0, -origin.y() / direction.y()) : kInfinity;
}

double way_out_of(const Box& box, const Vec3& origin, const Vec3& direction) {
  double out = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double side = direction[axis] > 0 ? 1.0 : -1.0;
    out = std::min(out, (side * box.half[axis] - origin[axis]) / direction[axis]);
  }
  return std::max(0.0, out);
}

/// The larger root of |origin + t direction| = radius; none if the line misses.
std::optional<double> far_root(const Vec3& origin, const Vec3& direction, double radius) {
  const double a = direction.squaredNorm(), b = origin.dot(direction);
  const double discriminant = b * b - a * (origin.squaredNorm() - radius * radius);
  if (!(a > 0) || !(discriminant >= 0)) return {};
  return (-b + std::sqrt(discriminant)) / a;
}

double way_out_of(const Capsule& capsule, const Vec3& origin, const Vec3& direction) {
  // The last point of the ray in any of its three parts: it is convex.
  double out = 0;
  for (const double y : {-capsule.half, capsule.half}) {
    out = std::max(out, far_root(origin - Vec3(0, y, 0), direction, capsule.radius).value_or(0));
  }
  const Vec3 flat(1, 0, 1);
  const auto side = far_root(origin.cwiseProduct(flat), direction.cwiseProduct(flat), capsule.radius);
  if (side && std::abs(origin.y() + *side * direction.y()) <= capsule.half) out = std::max(out, *side);
  return out;
}

double way_out_of(const Mesh& mesh, const Vec3& origin, const Vec3& direction) {
  return mesh.surface->way_out(origin, direction);
}

}  // namespace

Surface PlacedShape::surface(const Vec3& point) const {
  const Vec3 local = rotation.transpose() * (point - centre);
  Surface found = std::visit([&](const auto& s) { return surface_of(s, local); }, shape);
  found.normal = rotation * found.normal;
  return found;
}

bool PlacedShape::contains(const Vec3& point) const {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return mesh->surface->contains(rotation.transpose() * (point - centre));
  }
  const auto* sphere = std::get_if<Sphere>(&shape);
  return sphere != nullptr ? (point - centre).squaredNorm() < sphere->radius * sphere->radius
                           : surface(point).distance < 0;
}

std::optional<Hit> PlacedShape::first_hit(const Vec3& from, const Vec3& to) const {
  const Vec3 local = rotation.transpose() * (from - centre), way = rotation.transpose() * (to - from);
  std::optional<Hit> hit = std::visit([&](const auto& s) { return hit_of(s, local, way); }, shape);
  if (hit) hit->normal = rotation * hit->normal;
  return hit;
}

double PlacedShape::way_out(const Vec3& origin, const Vec3& direction) const {
  const Vec3 local = rotation.transpose() * (origin - centre), ray = rotation.transpose() * direction;
  return std::visit([&](const auto& s) { return way_out_of(s, local, ray); }, shape);
}

bool PlacedShape::may_touch(const Vec3& point, double reach) const {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return mesh->surface->may_touch(rotation.transpose() * (point - centre), reach);
  }
  return surface(point).distance < reach;
}

Eigen::AlignedBox3d PlacedShape::bounds() const {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const Eigen::AlignedBox3d& box = mesh->surface->bounds();
    const Vec3 middle = centre + rotation * box.center(), reach = rotation.cwiseAbs() * box.sizes() / 2;
    return {middle - reach, middle + reach};
  }
  Vec3 half = Vec3::Constant(kInfinity);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) half = Vec3::Constant(sphere->radius);
  if (const auto* box = std::get_if<Box>(&shape)) half = rotation.cwiseAbs() * box->half;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    half = rotation.col(1).cwiseAbs() * capsule->half + Vec3::Constant(capsule->radius);
  }
  return {centre - half, centre + half};
}

double bore(const Shape& shape) {
  Vec3 half;
  if (const auto* box = std::get_if<Box>(&shape)) {
    half = box->half;
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    half = mesh->surface->bounds().sizes() / 2;
  } else {
    return inner_radius(shape);
  }
  std::sort(half.begin(), half.end());
  return std::hypot(half[0], half[1]);
}

double outer_radius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* box = std::get_if<Box>(&shape)) return box->half.norm();
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->half + capsule->radius;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->surface->outer_radius();
  return kInfinity;
}

double inner_radius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* box = std::get_if<Box>(&shape)) return box->half.minCoeff();
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->surface->inner_radius();
  return kInfinity;
}

}  // namespace weft
