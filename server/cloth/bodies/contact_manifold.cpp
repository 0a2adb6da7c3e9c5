#include "cloth/bodies/contact_manifold.h"

#include <algorithm>
#include <optional>

#include "cloth/bodies/polytope.h"

namespace weft {
namespace {

using Points = std::vector<Vec3>;

/// Sine of the angle at which a face may lie to the normal: of the one that cuts, and of the one that is cut.
constexpr double kAligned = 0.01, kTilted = 0.1;
/// Cosine: by more the normal of what cuts is not off.
constexpr double kAbout = 0.9;

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

Vec3 mean(const Points& points) {
  Vec3 sum(0, 0, 0);
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

bool parallel(const Points& p, const Points& q) {
  constexpr double kSine = 0.05;
  const Vec3 u = (p[1] - p[0]).normalized(), v = (q[1] - q[0]).normalized();
  return u.cross(v).norm() < kSine;
}

/// The points of the other that lie over the face that looks `outwards` from one of them; none if it has none
/// there. `outwards` becomes the face's normal.
Points over_face(const Polytope& one, const Polytope& other, Vec3& outwards) {
  const Points reference = one.facing(outwards, kAligned);
  if (reference.size() < 3) return {};
  const Vec3 area = area_vector(reference).normalized();
  if (area.dot(outwards) < kAbout) return {};  // of the rim of something thin that stands on it
  outwards = area;                             // FCL's may be off by a little
  return over(reference, other.facing(-outwards, kTilted), outwards);
}

/// Where the other ends against the normal: the cut points are its nearest. The face is at `plane` along it.
void add_points(const Points& points, const Vec3& outwards, double plane, Manifold& manifold) {
  for (const Vec3& point : points) {
    const auto same = [&](const Manifold::Point& p) { return p.place == point; };
    if (std::any_of(manifold.points.begin(), manifold.points.end(), same)) continue;
    manifold.points.push_back({point, outwards.dot(point) - plane});
  }
}

/// What of the two lies over each other's faces, one of which looks along about `normal`, from b to a.
Manifold over_faces(const Polytope& a, const Polytope& b, const Vec3& normal) {
  Manifold found;
  found.normal = normal;
  for (const bool on_b : {true, false}) {
    const Polytope &one = on_b ? b : a, &other = on_b ? a : b;
    Vec3 outwards = on_b ? normal : Vec3(-normal);
    const Points points = over_face(one, other, outwards);
    if (points.empty()) continue;
    found.normal = on_b ? outwards : Vec3(-outwards);
    const double plane = one.reach(outwards);
    add_points(points, outwards, plane, found);
    break;
  }
  return found;
}

void leave_out_beyond(double margin, Manifold& manifold) {
  std::erase_if(manifold.points, [&](const Manifold::Point& point) { return point.gap > margin; });
}

}  // namespace

Manifold manifold_of(const PlacedShape& shape_a, const PlacedShape& shape_b, const Vec3& about,
                     const Vec3& deepest, double margin) {
  const Polytope a(shape_a), b(shape_b);
  const Vec3 normal = least_overlap(a, b, about);
  Manifold found = over_faces(a, b, normal);
  if (found.points.empty()) {
    const double plane = b.reach(normal), gap = -a.reach(-normal) - plane;
    const Points edge_a = a.facing(-normal, kTilted), edge_b = b.facing(normal, kAligned);
    if (edge_a.size() == 2 && edge_b.size() == 2 && parallel(edge_a, edge_b)) {
      add_points(over(edge_b, edge_a, normal), normal, plane, found);
    } else {
      const Vec3 middle = mean(edge_a.size() <= edge_b.size() ? edge_a : edge_b);
      found.points.push_back({normal == about ? deepest : middle, gap});
    }
  }
  leave_out_beyond(margin, found);
  return found;
}

Manifold manifold_before(const PlacedShape& shape_a, const PlacedShape& shape_b, double margin) {
  const Polytope a(shape_a), b(shape_b);
  const std::optional<Vec3> normal = parting_face(a, b);
  if (!normal) return {};
  Manifold found = over_faces(a, b, *normal);
  leave_out_beyond(margin, found);
  return found;
}

}  // namespace weft
