#include "cloth/shapes/mass_properties.h"
#include "cloth/shapes/shape.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {

Surface Mesh::nearest(const Vec3& point) const {
  const TriangleMesh::Nearest found = surface->nearest(point);
  return {found.distance, found.normal};
}

bool Mesh::contains(const Vec3& point) const { return surface->contains(point); }

std::optional<Hit> Mesh::first_hit(const Vec3& from, const Vec3& way) const {
  const std::optional<TriangleMesh::Crossing> entry = surface->first_entry(from, way);
  return entry ? std::optional<Hit>({entry->fraction, entry->normal}) : std::nullopt;
}

double Mesh::way_out(const Vec3& origin, const Vec3& direction) const {
  return surface->way_out(origin, direction);
}

Eigen::AlignedBox3d Mesh::bounds(const Vec3& centre, const Eigen::Matrix3d& rotation) const {
  const Eigen::AlignedBox3d& box = surface->bounds();
  const Vec3 middle = centre + rotation * box.center(), reach = rotation.cwiseAbs() * box.sizes() / 2;
  return {middle - reach, middle + reach};
}

double Mesh::inner_radius() const { return surface->inner_radius(); }
double Mesh::bore() const { return Box{surface->bounds().sizes() / 2}.bore(); }
double Mesh::outer_radius() const { return surface->outer_radius(); }

MassProperties Mesh::mass_properties() const { return weft::mass_properties(surface->list()); }

std::vector<Face> Mesh::faces() const { return surface->faces(); }

std::vector<Corner> Mesh::corners() const {
  std::vector<Corner> all;
  const TriangleList& list = surface->list();
  for (const Vec3& vertex : list.vertices) all.push_back({.place = vertex});
  for (const std::array<int, 3>& triangle : list.triangles) {
    const auto vertex = [&](int i) {
      return static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)]);
    };
    const Vec3 &p = list.vertices[vertex(0)], &q = list.vertices[vertex(1)], &r = list.vertices[vertex(2)];
    for (int i = 0; i < 3; ++i) all[vertex(i)].outwards += (q - p).cross(r - p);
  }
  for (Corner& corner : all) corner.outwards.normalize();
  return all;
}

bool Mesh::is_convex() const { return surface->list().convex; }

}  // namespace weft
