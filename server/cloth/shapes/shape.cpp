#include "cloth/shapes/shape.h"

#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {

Surface PlacedShape::surface(const Vec3& point) const {
  const Vec3 local = rotation.transpose() * (point - centre);
  Surface found = std::visit([&](const auto& s) { return s.nearest(local); }, shape);
  found.normal = rotation * found.normal;
  return found;
}

bool PlacedShape::contains(const Vec3& point) const {
  const Vec3 arm = point - centre;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->contains(arm);  // however turned
  const Vec3 local = rotation.transpose() * arm;
  return std::visit([&](const auto& s) { return s.contains(local); }, shape);
}

std::optional<Hit> PlacedShape::first_hit(const Vec3& from, const Vec3& to) const {
  const Vec3 local = rotation.transpose() * (from - centre), way = rotation.transpose() * (to - from);
  std::optional<Hit> hit = std::visit([&](const auto& s) { return s.first_hit(local, way); }, shape);
  if (hit) hit->normal = rotation * hit->normal;
  return hit;
}

double PlacedShape::way_out(const Vec3& origin, const Vec3& direction) const {
  const Vec3 local = rotation.transpose() * (origin - centre), ray = rotation.transpose() * direction;
  return std::visit([&](const auto& s) { return s.way_out(local, ray); }, shape);
}

bool PlacedShape::may_touch(const Vec3& point, double reach) const {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return mesh->surface->may_touch(rotation.transpose() * (point - centre), reach);
  }
  return surface(point).distance < reach;
}

Eigen::AlignedBox3d PlacedShape::bounds() const {
  return std::visit([&](const auto& s) { return s.bounds(centre, rotation); }, shape);
}

double inner_radius(const Shape& shape) {
  return std::visit([](const auto& s) { return s.inner_radius(); }, shape);
}

double bore(const Shape& shape) {
  return std::visit([](const auto& s) { return s.bore(); }, shape);
}

double outer_radius(const Shape& shape) {
  return std::visit([](const auto& s) { return s.outer_radius(); }, shape);
}

MassProperties mass_properties(const Shape& shape) {
  return std::visit([](const auto& s) { return s.mass_properties(); }, shape);
}

std::vector<Corner> corners_of(const Shape& shape) {
  return std::visit([](const auto& s) { return s.corners(); }, shape);
}

std::vector<Face> faces_of(const Shape& shape) {
  return std::visit([](const auto& s) { return s.faces(); }, shape);
}

bool is_convex(const Shape& shape) {
  return std::visit([](const auto& s) { return s.is_convex(); }, shape);
}

}  // namespace weft
