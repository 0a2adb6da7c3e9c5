#include "cloth/bodies/contact_manifold.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/shapes/triangle_mesh.h"

namespace weft {
namespace {

using Points = std::vector<Vec3>;

/// Of a shape's outer radius: how far its corners may lie below its highest one and still be of one face; of
/// the face that cuts and of the one that is cut, which may lie on it at an angle.
constexpr double kFlatFace = 0.01, kTilted = 0.1;

/// The shape's corners in the world.
std::vector<Corner> placed_corners(const PlacedShape& shape) {
  std::vector<Corner> corners = corners_of(shape.shape);
  for (Corner& corner : corners) corner.place = shape.centre + shape.rotation * corner.place;
  return corners;
}

/// How far they reach along the direction.
double reach(const std::vector<Corner>& corners, const Vec3& direction) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Corner& c : corners) farthest = std::max(farthest, direction.dot(c.place) + c.radius);
  return farthest;
}

/// The convex outline of the points as seen against the unit `direction`, counterclockwise (Andrew's monotone
/// chain, 1979). Points in one place are one; of points in a line it is the two ends.
Points outline(Points points, const Vec3& direction) {
  const Vec3 x = direction.unitOrthogonal(), y = direction.cross(x);
  std::sort(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
    const double along = x.dot(p) - x.dot(q);
    return along != 0 ? along < 0 : y.dot(p) < y.dot(q);
  });
  const auto turns_left = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
    constexpr double kLine = 1e-6;  // sine of the angle, or what is one place, relative
    const double area = direction.dot((q - p).cross(r - q));
    return area > kLine * (q - p).norm() * (r - p).norm();
  };
  Points found;
  for (const bool back : {false, true}) {
    const std::size_t first = found.size();
    for (const Vec3& p : points) {
      while (found.size() >= first + 2 && !turns_left(found[found.size() - 2], found.back(), p)) {
        found.pop_back();
      }
      found.push_back(p);
    }
    found.pop_back();
    if (!back) std::reverse(points.begin(), points.end());
  }
  if (found.empty() && !points.empty()) found.push_back(points.front());
  return found;
}

/// The outline of those corners that are within `depth`, m, of the highest along the direction.
Points face(const std::vector<Corner>& corners, const Vec3& direction, double depth) {
  const double highest = reach(corners, direction);
  Points points;
  for (const Corner& c : corners) {
    if (direction.dot(c.place) + c.radius >= highest - depth) {
      points.emplace_back(c.place + c.radius * direction);
    }
  }
  return outline(std::move(points), direction);
}

/// Of a closed outline, by Newell's method; its length is twice the area.
Vec3 area_vector(const Points& outline) {
  Vec3 sum(0, 0, 0);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    sum += (outline[i] - outline[0]).cross(outline[(i + 1) % outline.size()] - outline[0]);
  }
  return sum;
}

/// What of the outline is behind the plane through `place` (Sutherland and Hodgman, 1974).
Points clipped(const Points& outline, const Vec3& place, const Vec3& outwards) {
  Points kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &from = outline[i], &to = outline[(i + 1) % outline.size()];
    const double at_from = outwards.dot(from - place), at_to = outwards.dot(to - place);
    if (at_from <= 0) kept.push_back(from);
    if ((at_from < 0 && at_to > 0) || (at_from > 0 && at_to < 0)) {
      kept.emplace_back(from + at_from / (at_from - at_to) * (to - from));
    }
  }
  return kept;
}

/// What of `cut` is over `reference`, a face or an edge.
Points over(const Points& reference, Points cut, const Vec3& normal) {
  if (reference.size() == 2) {
    const Vec3 along = reference[1] - reference[0];
    return clipped(clipped(cut, reference[1], along), reference[0], -along);
  }
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Vec3 side = reference[(i + 1) % reference.size()] - reference[i];
    cut = clipped(cut, reference[i], side.cross(normal));
  }
  return cut;
}

bool parallel(const Points& p, const Points& q) {
  constexpr double kSine = 0.05;
  const Vec3 u = (p[1] - p[0]).normalized(), v = (q[1] - q[0]).normalized();
  return u.cross(v).norm() < kSine;
}

/// One of the two while its face is looked for, and the other.
struct Side {
  const std::vector<Corner>*corners, *others;
  double size, other_size;  ///< outer radii, m
  Vec3 outwards;            ///< along the normal
};

/// The points over the side's face; none if it has none there.
Points over_face_of(const Side& side, Vec3& outwards) {
  const Points reference = face(*side.corners, side.outwards, kFlatFace * side.size);
  if (reference.size() < 3) return {};
  const Vec3 area = area_vector(reference);
  outwards = area.normalized();  // FCL's may be off by a little
  return over(reference, face(*side.others, -outwards, kTilted * side.other_size), outwards);
}

}  // namespace

Manifold manifold_of(const PlacedShape& a, const PlacedShape& b, const Vec3& normal, const Vec3& deepest,
                     double margin) {
  const std::vector<Corner> of_a = placed_corners(a), of_b = placed_corners(b);
  const double size_a = outer_radius(a.shape), size_b = outer_radius(b.shape);
  Manifold found;
  const auto keep = [&](const Points& points) {
    // Where the other ends against the normal: the cut points are its nearest.
    for (const Vec3& point : points) {
      const auto same = [&](const Manifold::Point& p) { return p.place == point; };
      if (std::any_of(found.points.begin(), found.points.end(), same)) continue;
      found.points.push_back({point, 0});
    }
  };
  for (const bool on_b : {true, false}) {
    const Side side =
        on_b ? Side{&of_b, &of_a, size_b, size_a, normal} : Side{&of_a, &of_b, size_a, size_b, Vec3(-normal)};
    Vec3 outwards;
    keep(over_face_of(side, outwards));
    if (found.points.empty()) continue;
    found.normal = on_b ? outwards : Vec3(-outwards);
    const double plane = reach(*side.corners, outwards);
    for (Manifold::Point& point : found.points) point.gap = outwards.dot(point.place) - plane;
    break;
  }
  if (found.points.empty()) {
    found.normal = normal;
    const double plane = reach(of_b, normal), gap = -reach(of_a, -normal) - plane;
    const Points edge_a = face(of_a, -normal, kTilted * size_a),
                 edge_b = face(of_b, normal, kFlatFace * size_b);
    if (edge_a.size() == 2 && edge_b.size() == 2 && parallel(edge_a, edge_b)) {
      keep(over(edge_b, edge_a, normal));
      for (Manifold::Point& point : found.points) point.gap = normal.dot(point.place) - plane;
    } else {
      found.points.push_back({deepest, gap});
    }
  }
  std::erase_if(found.points, [&](const Manifold::Point& point) { return point.gap > margin; });
  return found;
}

}  // namespace weft
