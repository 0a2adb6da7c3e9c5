#pragma once
#include <array>
#include <optional>

#include "cloth/core/vec3.h"

namespace weft {

/// One of a surface's triangles, its corners counterclockwise as seen from outside.
struct Triangle {
  std::array<Vec3, 3> corner;
  Vec3 normal{0, 1, 0};  ///< unit, outwards
};

/// What part of a triangle a point is nearest to: corner 0 to 2, the edge from corner 0 to 2 to the next (3
/// to 5), or its face.
enum class Feature { corner = 0, edge = 3, face = 6 };

/// The point of a triangle next to some point.
struct NearestOnTriangle {
  Vec3 point{0, 0, 0};
  int feature = int(Feature::face);  ///< as Feature: its value, plus which
};

/// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi region of the triangle's features.
inline NearestOnTriangle nearest_on(const Triangle& triangle, const Vec3& p) {
  const auto& [a, b, c] = triangle.corner;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 3};
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 4};
  }
  // Along the normal: exact where the sum of the corners by va, vb, vc would lose digits.
  return {p - triangle.normal.dot(ap) * triangle.normal, int(Feature::face)};
}

/// Where a straight way crosses triangles, in their order on it. Watertight (Woop, Benthin, Wald 2013): a way
/// that crosses a closed surface crosses one of its triangles, never slipping between two that share an edge.
class WayAcross {
 public:
  /// `way` must not be zero.
  WayAcross(const Vec3& from, const Vec3& way) : from_(from) {
    way.cwiseAbs().maxCoeff(&z_);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    shear_ = {way[x_] / way[z_], way[y_] / way[z_], 1 / way[z_]};
  }
  /// The fraction of the way, perhaps beyond 0..1, at which it crosses the triangle's plane inside it; none
  /// if it does not, or runs in the plane.
  std::optional<double> crossing(const Triangle& triangle) const {
    const auto& [a, b, c] = triangle.corner;
    const Vec3 pa = sheared(a), pb = sheared(b), pc = sheared(c);
    const double u = pc.x() * pb.y() - pc.y() * pb.x();
    const double v = pa.x() * pc.y() - pa.y() * pc.x();
    const double w = pb.x() * pa.y() - pb.y() * pa.x();
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
    const double sum = u + v + w;
    if (sum == 0) return {};
    return (u * pa.z() + v * pb.z() + w * pc.z()) / sum;
  }

 private:
  /// The way becomes the stretch from 0 to 1 of the z axis.
  Vec3 sheared(const Vec3& corner) const {
    const Vec3 p = corner - from_;
    return {p[x_] - shear_.x() * p[z_], p[y_] - shear_.y() * p[z_], shear_.z() * p[z_]};
  }
  Vec3 from_, shear_;
  int x_ = 0, y_ = 1, z_ = 2;
};

}  // namespace weft
