#include "cloth/shapes/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cloth/shapes/closed_surface.h"

namespace weft {
namespace {

/// Nearer to the surface than this part of the solid's size the direction to it is lost in rounding.
constexpr double kOnSurface = 1e-12;

std::vector<Triangle> triangles_of(const TriangleList& list) {
  std::vector<Triangle> triangles;
  triangles.reserve(list.triangles.size());
  for (const std::array<int, 3>& corners : list.triangles) {
    Triangle& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corner[k] = list.vertices[static_cast<std::size_t>(corners[k])];
    }
    const auto& [a, b, c] = triangle.corner;
    triangle.normal = (b - a).cross(c - a).normalized();
  }
  return triangles;
}

/// Triangles whose normals differ by less make up one face.
constexpr double kOneFace = 1e-6;

/// Those of the triangles, each once.
std::vector<Face> faces_of(const std::vector<Triangle>& triangles) {
  std::map<std::array<long, 3>, Face> faces;
  for (const Triangle& triangle : triangles) {
    const auto rounded = [&](int axis) { return std::lround(triangle.normal[axis] / kOneFace); };
    const Face face{triangle.normal, triangle.normal.dot(triangle.corner[0])};
    faces.try_emplace({rounded(0), rounded(1), rounded(2)}, face);
  }
  std::vector<Face> all;
  all.reserve(faces.size());
  for (const auto& [normal, face] : faces) all.push_back(face);
  return all;
}

double angle_at(const Triangle& triangle, std::size_t k) {
  const Vec3 to_next = triangle.corner[(k + 1) % 3] - triangle.corner[k],
             to_last = triangle.corner[(k + 2) % 3] - triangle.corner[k];
  return std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
}

}  // namespace

TriangleMesh::TriangleMesh(const TriangleList& list)
    : list_(closed_surface(list)), triangles_(triangles_of(list_)), pseudonormals_(triangles_.size()) {
  std::vector<Vec3> corner_normals(list_.vertices.size(), Vec3(0, 0, 0));
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      corner_normals[static_cast<std::size_t>(list_.triangles[t][k])] +=
          angle_at(triangles_[t], k) * triangles_[t].normal;
    }
  }
  const std::vector<std::array<int, 3>> neighbours = edge_neighbours(list_);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      pseudonormals_[t][k] = corner_normals[static_cast<std::size_t>(list_.triangles[t][k])];
      pseudonormals_[t][3 + k] =
          triangles_[t].normal + triangles_[static_cast<std::size_t>(neighbours[t][k])].normal;
    }
  }
  if (list_.convex) faces_ = faces_of(triangles_);
  for (const Vec3& vertex : list_.vertices) {
    bounds_.extend(vertex);
    outer_radius_ = std::max(outer_radius_, vertex.norm());
  }
  const auto inside = [this](const Vec3& point, const TriangleOctree::Nearest& nearest) {
    return side_of(point, nearest) < 0;
  };
  cells_.emplace(triangles_, list_.convex, inside);
  inner_radius_ = outer_radius_;
  for (const Triangle& triangle : triangles_) {
    const Vec3 inwards = -triangle.normal,
               middle = (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3;
    inner_radius_ =
        std::min(inner_radius_, way_out(middle + kOnSurface * outer_radius_ * inwards, inwards) / 2);
  }
}

const Vec3& TriangleMesh::normal_of(const TriangleOctree::Nearest& nearest) const {
  const int feature = nearest.found.feature;
  return feature == int(Feature::face) ? triangles_[nearest.triangle].normal
                                       : pseudonormals_[nearest.triangle][static_cast<std::size_t>(feature)];
}

/// Negative inside.
double TriangleMesh::side_of(const Vec3& point, const TriangleOctree::Nearest& nearest) const {
  return normal_of(nearest).dot(point - nearest.found.point);
}

TriangleMesh::Nearest TriangleMesh::nearest(const Vec3& point) const {
  const TriangleOctree::Nearest nearest = cells_->nearest(point, cells_->cell_at(point));
  const double sign = side_of(point, nearest) < 0 ? -1.0 : 1.0, distance = std::sqrt(nearest.square);
  const bool direct = nearest.found.feature == int(Feature::face) || distance <= kOnSurface * outer_radius_;
  return {sign * distance,
          direct ? normal_of(nearest).normalized() : Vec3(sign / distance * (point - nearest.found.point))};
}

bool TriangleMesh::contains(const Vec3& point) const {
  const TriangleOctree::Cell* cell = cells_->cell_at(point);
  if (cell == nullptr) return false;
  if (cell->side != TriangleOctree::Side::crossed) return cell->side == TriangleOctree::Side::inside;
  return cell->convex ? cells_->is_below_all(point, *cell) : side_of(point, cells_->nearest(point, cell)) < 0;
}

bool TriangleMesh::may_touch(const Vec3& point, double reach) const {
  const TriangleOctree::Cell* cell = cells_->cell_at(point);
  if (cell != nullptr && cell->side != TriangleOctree::Side::outside) return true;
  return cells_->clearance(point, cell) < reach;
}

std::optional<TriangleMesh::Crossing> TriangleMesh::first_entry(const Vec3& from, const Vec3& way) const {
  if (way.isZero(0) || !may_touch(from, way.norm())) return {};
  std::optional<Crossing> entry;
  double exit = 2;  // fraction of the way; beyond it: none
  const WayAcross across(from, way);
  cells_->for_each_along(from, from + way, [&](std::size_t t) {
    const Triangle& triangle = triangles_[t];
    const std::optional<double> at = across.crossing(triangle);
    if (!at || !(*at >= 0 && *at <= 1)) return;
    if (way.dot(triangle.normal) > 0) {
      exit = std::min(exit, *at);
    } else if (!entry || *at < entry->fraction) {
      entry = Crossing{*at, triangle.normal};
    }
  });
  if (exit < (entry ? entry->fraction : 2)) {
    // What is on the surface may, by rounding, begin inside: then it enters where it is, unless it leaves.
    const Nearest start = nearest(from);
    if (start.distance <= kOnSurface * outer_radius_ && way.dot(start.normal) < 0) {
      return Crossing{0, start.normal};
    }
  }
  return entry;
}

double TriangleMesh::way_out(const Vec3& origin, const Vec3& direction) const {
  const double longest = 2 * bounds_.diagonal().norm();  // from inside
  double out = longest;
  const WayAcross across(origin, direction);
  cells_->for_each_along(origin, origin + longest * direction, [&](std::size_t t) {
    const std::optional<double> at = across.crossing(triangles_[t]);
    if (at && *at >= 0 && direction.dot(triangles_[t].normal) > 0) out = std::min(out, *at);
  });
  return out < longest ? out : 0.0;  // none: it is on the surface, by rounding beyond it
}

std::size_t TriangleMesh::bytes() const {
  return list_.vertices.capacity() * sizeof(Vec3) + list_.triangles.capacity() * sizeof(list_.triangles[0]) +
         triangles_.capacity() * sizeof(Triangle) + pseudonormals_.capacity() * sizeof(Pseudonormals) +
         cells_->bytes();
}

}  // namespace weft
