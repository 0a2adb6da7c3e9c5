#include "cloth/bodies/polytope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft {
namespace {

/// Corners of one face lie in a plane but for this part of the outer radius, and of the inner one: the two
/// sides of what is thin are two faces.
constexpr double kFlat = 0.01, kThin = 0.5;
/// Of the overlap along the normal that is known: as much less it must be along another one. Where two differ
/// by less the contact would go from one to the other and back.
constexpr double kBetter = 0.9;
/// Of the smaller outer radius: what overlaps by so little along its faces may be parted by its edges. Held
/// by the face all the while, and not now and then, it comes to rest.
constexpr double kTouch = 0.01;
/// Faces of one times corners of the other: with more FCL's normal is taken as it is. As many are looked at
/// in a fifth of a millisecond.
constexpr std::size_t kMostProducts = 200000;

/// The convex outline of the points as seen against the unit `direction`, counterclockwise (Andrew's monotone
/// chain, 1979). Points in one place are one; of points in a line it is the two ends.
std::vector<Vec3> outline(std::vector<Vec3> points, const Vec3& direction) {
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
  std::vector<Vec3> found;
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

}  // namespace

Polytope::Polytope(const PlacedShape& shape)
    : corners_(corners_of(shape.shape)),
      faces_(faces_of(shape.shape)),
      size_(outer_radius(shape.shape)),
      flat_(std::min(kFlat * size_, kThin * inner_radius(shape.shape))) {
  for (Corner& corner : corners_) corner.place = shape.centre + shape.rotation * corner.place;
  for (Face& face : faces_) {
    face.normal = shape.rotation * face.normal;
    face.height += face.normal.dot(shape.centre);
  }
}

double Polytope::reach(const Vec3& direction) const {
  return reach_up_to(direction, std::numeric_limits<double>::infinity());
}

double Polytope::reach_up_to(const Vec3& direction, double enough) const {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Corner& c : corners_) {
    farthest = std::max(farthest, direction.dot(c.place) + c.radius);
    if (farthest >= enough) break;
  }
  return farthest;
}

std::vector<Vec3> Polytope::highest(const Vec3& direction, double depth) const {
  const double top = reach(direction);
  std::vector<Vec3> points;
  for (const Corner& c : corners_) {
    if (direction.dot(c.place) + c.radius >= top - depth) points.emplace_back(c.place + c.radius * direction);
  }
  return outline(std::move(points), direction);
}

std::vector<Vec3> Polytope::facing(const Vec3& direction, double tilt) const {
  const auto face = std::max_element(faces_.begin(), faces_.end(), [&](const Face& p, const Face& q) {
    return p.normal.dot(direction) < q.normal.dot(direction);
  });
  if (face != faces_.end() && face->normal.dot(direction) > 0 && face->normal.cross(direction).norm() <= tilt)
    return highest(face->normal, flat_);
  return highest(direction, tilt * size_);
}

namespace {

/// The face along which they overlap least, by less than `least`, which becomes that, m.
std::optional<Vec3> face_of_less(const Polytope& a, const Polytope& b, double& least) {
  if (a.faces().size() * b.corners() + b.faces().size() * a.corners() > kMostProducts) return std::nullopt;
  std::optional<Vec3> best;
  const auto look = [&](const Polytope& one, const Polytope& other, double sign) {
    for (const Face& face : one.faces()) {
      const double overlap = face.height + other.reach_up_to(-face.normal, least - face.height);
      if (!(overlap < least)) continue;
      least = overlap;
      best = sign * face.normal;
    }
  };
  look(b, a, 1);
  look(a, b, -1);
  return best;
}

}  // namespace

Vec3 least_overlap(const Polytope& a, const Polytope& b, const Vec3& known) {
  double least = b.reach(known) + a.reach(-known);
  least -= (1 - kBetter) * std::abs(least);
  return face_of_less(a, b, least).value_or(known);
}

std::optional<Vec3> parting_face(const Polytope& a, const Polytope& b) {
  double least = std::numeric_limits<double>::infinity();
  const std::optional<Vec3> face = face_of_less(a, b, least);
  return least <= kTouch * std::min(a.size(), b.size()) ? face : std::nullopt;
}

}  // namespace weft
