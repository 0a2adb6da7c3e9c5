#include "cloth/bodies/body_meeting.h"

#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cloth/bodies/contact_manifold.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {
namespace {

using Geometry = BodyGeometry::Geometry;

/// Of the margin: so far back on its way a pinned node is told which face it comes to.
constexpr double kSeenFrom = 0.03;
/// Of the margin: so far from a corner that has come in, or from where surfaces cross, the surface is read
/// that is met there.
constexpr double kInwards = 0.2;

const TriangleMesh* surface_of(const Solid& solid) {
  const auto* mesh = std::get_if<Mesh>(&solid.shape);
  return mesh == nullptr ? nullptr : mesh->surface;
}

/// How far any of its points moves in the step by its turn at most, m.
double most_turned(const Solid& solid) {
  return solid.turns() ? solid.turn.norm() * outer_radius(solid.shape) : 0;
}

/// How far any of its points moves in the step at most, m.
double most_move(const Solid& solid) { return (solid.position - solid.start).norm() + most_turned(solid); }

/// Two solids while their contacts are looked for.
class BodyMeeting {
 public:
  BodyMeeting(const Solid& a, const Solid& b, std::pair<int, int> pair, double dt,
              std::vector<BodyContact>& contacts)
      : index_(pair),
        a_(a),
        b_(b),
        margin_(kBodyMargin * std::min(half_width(a_), half_width(b_))),
        dt_(dt),
        contacts_(contacts) {}

  void look(BodyGeometry& geometry) {
    if (looked_at_on_its_way() && sweep()) return;
    if (is_half_space(b_) || is_ball(a_)) {
      look_at_corners(false);
    } else if (is_ball(b_)) {
      look_at_corners(true);
    } else if (is_convex(a_.shape) && is_convex(b_.shape)) {
      look_at_faces(geometry.of(a_), geometry.of(b_));
    } else {
      look_at_corners(false);
      look_at_corners(true);
      look_at_crossings(geometry.of(a_), geometry.of(b_));
    }
  }

 private:
  /// Where it ends says nothing of where it came from. What is next to a node that has come in by a little at
  /// a body's edge may be another face than the one it came through.
  bool looked_at_on_its_way() const {
    const Vec3 way = (a_.position - a_.start) - (b_.position - b_.start);
    return is_pinned_node(b_) ||
           (!is_half_space(b_) && way.norm() + most_turned(a_) + most_turned(b_) > margin_);
  }

  /// Where the corners of one meet the other on their ways; false if none does.
  bool sweep() {
    const std::size_t before = contacts_.size();
    if (is_ball(a_) || !is_ball(b_)) sweep_corners(false);
    if (!is_ball(a_)) sweep_corners(true);
    return contacts_.size() > before;
  }

  /// Of a, or of b if `swapped`, where they end next to the other.
  void look_at_corners(bool swapped) {
    const Solid &on = swapped ? a_ : b_, &corners = swapped ? b_ : a_;
    const PlacedShape shape = on.placed(1);
    for (const Corner& corner : corners_of(corners.shape)) {
      const Vec3 place = corners.position + corners.rotation * corner.place;
      if (!shape.may_touch(place, corner.radius + margin_)) continue;
      const Surface surface = surface_at(shape, place, corners.rotation * corner.outwards);
      const double gap = surface.distance - corner.radius;
      if (gap > margin_) continue;
      const Vec3 at = place - corner.radius * surface.normal;
      add(at - a_.position, at - b_.position, swapped ? Vec3(-surface.normal) : surface.normal, gap);
    }
  }

  void look_at_faces(const Geometry& of_a, const Geometry& of_b) {
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    fcl::collide(of_b.get(), end_of(b_), of_a.get(), end_of(a_), request, result);
    const PlacedShape a = a_.placed(1), b = b_.placed(1);
    // Of two shapes that touch by rounding it has no normal.
    const bool overlap = result.isCollision() && result.getContact(0).normal.squaredNorm() > 0.5;
    const Manifold manifold = overlap ? manifold_of(a, b, result.getContact(0).normal.normalized(),
                                                    result.getContact(0).pos, margin_)
                                      : manifold_before(a, b, margin_);
    for (const Manifold::Point& point : manifold.points) {
      add(point.place - a_.position, point.place - b_.position, manifold.normal, point.gap);
    }
  }

  /// Where the surfaces cross they come no nearer: how deep they are in each other there FCL does not say.
  void look_at_crossings(const Geometry& of_a, const Geometry& of_b) {
    constexpr std::size_t kMostCrossings = 64;
    fcl::CollisionRequestd request(kMostCrossings, true);
    fcl::CollisionResultd result;
    fcl::collide(of_b.get(), end_of(b_), of_a.get(), end_of(a_), request, result);
    const PlacedShape a = a_.placed(1), b = b_.placed(1);
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const Vec3 place = result.getContact(i).pos;
      if (!place.allFinite()) continue;
      const std::optional<Vec3> along = normal_of_crossing(a, b, place);
      if (!along) continue;
      const Vec3 arm_a = place - a_.position, arm_b = place - b_.position;
      const Vec3 move = move_of(in_the_middle(a_, arm_a, -*along, 1), in_the_middle(b_, arm_b, *along, 1));
      add(arm_a, arm_b, *along, along->dot(move));
    }
  }

  /// From b to a, where their surfaces cross. What of them is next to that place may be the face beside an
  /// edge that has come in by a little. A little way into one, against its normal, is out of what has come in
  /// there: the other's surface looks against that normal, if it is the face or the edge that is met. None if
  /// it does so for neither.
  std::optional<Vec3> normal_of_crossing(const PlacedShape& a, const PlacedShape& b,
                                         const Vec3& place) const {
    constexpr double kAgainst = 0.1;
    const double beside = kInwards * margin_;
    const Vec3 out_of_a = a.surface(place).normal, out_of_b = b.surface(place).normal;
    const Vec3 by_b = b.surface(place - beside * out_of_a).normal;
    const Vec3 by_a = -a.surface(place - beside * out_of_b).normal;
    const double against_a = -out_of_a.dot(by_b), against_b = out_of_b.dot(by_a);
    if (!(std::max(against_a, against_b) > kAgainst)) return std::nullopt;
    return against_a > against_b ? by_b : by_a;
  }

  /// A pinned node has none: it counts by what it meets.
  static double half_width(const Solid& solid) {
    return is_pinned_node(solid) ? std::numeric_limits<double>::infinity() : inner_radius(solid.shape);
  }
  /// The ball about its origin that it holds.
  static Corner core_of(const Shape& shape) {
    if (surface_of({.shape = shape}) == nullptr) return {.radius = inner_radius(shape)};
    return {.radius = std::max(0.0, -PlacedShape{shape}.surface(Vec3(0, 0, 0)).distance)};
  }

  /// A corner that is in by a little, next to an edge, is told the face beyond the edge: one that looks the
  /// same way as it does. It came from where its own solid is, so what of the surface is next to a place a
  /// little within that is the one it met.
  Surface surface_at(const PlacedShape& shape, const Vec3& place, const Vec3& outwards) const {
    Surface nearest = shape.surface(place);
    if (nearest.normal.dot(outwards) <= 0) return nearest;
    const Vec3 back = kInwards * margin_ * outwards;
    const Surface met = shape.surface(place - back);
    return {met.distance + met.normal.dot(back), met.normal};
  }

  void sweep_corners(bool swapped) {
    const Solid &on = swapped ? a_ : b_, &corners = swapped ? b_ : a_;
    std::vector<Corner> all = corners_of(corners.shape);
    if (!is_ball(corners)) all.push_back(core_of(corners.shape));
    for (const Corner& corner : all) sweep(corner, corners, on, swapped);
  }

  void sweep(const Corner& corner, const Solid& corners, const Solid& on, bool swapped) {
    constexpr int kSteps = 64;
    // Nearer than this they meet; it stays a gap.
    const double near = 1e-3 * margin_;
    const auto place_at = [&](double share) {
      const PlacedShape placed = corners.placed(share);
      return Vec3(placed.centre + placed.rotation * corner.place);
    };
    const double most = most_move(corners) + most_move(on) +
                        on.turn.norm() * ((corners.start - on.start).norm() + most_move(corners));
    double share = 0;
    for (int i = 0; i < kSteps && share < 1; ++i) {
      const Vec3 place = place_at(share);
      const Surface surface = on.placed(share).surface(place);
      const double gap = surface.distance - corner.radius;
      if (gap > near) {
        share += gap / most;
        continue;
      }
      const Vec3 further = place_at(1) - place - on.move_of(place, share, 1);
      // At an edge a pinned node meets the face it comes through, not the one that rounding finds next to it.
      const double away = is_pinned_node(corners) ? kSeenFrom * margin_ : 0;
      const Vec3 back = away * further.stableNormalized();
      const Surface met = on.placed(share).surface(place - back);
      const double end = met.normal.dot(further + back) + met.distance - corner.radius;
      if (end > margin_) return;
      const Vec3 at = place - corner.radius * met.normal;
      const Vec3 arm_corner = at - corners.at(share), arm_on = at - on.at(share);
      if (swapped) {
        add(arm_on, arm_corner, -met.normal, end, share);
      } else {
        add(arm_corner, arm_on, met.normal, end, share);
      }
      return;
    }
  }

  /// Of a's point as seen from b's, in the step, m; the arms as they are in its middle.
  Vec3 move_of(const Vec3& arm_a, const Vec3& arm_b) const {
    return dt_ * (a_.velocity + a_.spin.cross(arm_a) - b_.velocity - b_.spin.cross(arm_b));
  }
  /// The arm, which is as it is at `share` of the step, in its middle: the way of a point of what turns is
  /// its velocity there but for the third order of the turn. By those of the step's end a body that rolls
  /// over an edge would be told, of the second, that it was in before. What is round there touches with the
  /// point that is next to the other all the while: its centre turns, and not the radius from there.
  static Vec3 in_the_middle(const Solid& solid, const Vec3& arm, const Vec3& outwards, double share) {
    if (!solid.turns()) return arm;
    const Vec3 radius = rounding(solid.shape) * outwards;
    const Eigen::AngleAxisd turn((0.5 - share) * solid.turn.norm(), solid.turn.stableNormalized());
    return turn * Vec3(arm - radius) + radius;
  }
  static double rounding(const Shape& shape) {
    const auto* capsule = std::get_if<Capsule>(&shape);
    return capsule == nullptr ? 0 : capsule->radius;  // balls do not turn
  }
  /// The arms at `share` of the step; `end` is the gap at its end.
  void add(const Vec3& arm_a, const Vec3& arm_b, const Vec3& normal, double end, double share = 1) {
    const Vec3 middle_a = in_the_middle(a_, arm_a, -normal, share);
    const Vec3 middle_b = in_the_middle(b_, arm_b, normal, share);
    contacts_.push_back({.a = index_.first,
                         .b = index_.second,
                         .arm_a = middle_a,
                         .arm_b = middle_b,
                         .normal = normal,
                         .gap = end - normal.dot(move_of(middle_a, middle_b)),
                         .friction = std::sqrt(a_.friction * b_.friction),
                         .firm = is_firm(a_, b_)});
  }

  std::pair<int, int> index_;
  const Solid &a_, &b_;
  double margin_, dt_;
  std::vector<BodyContact>& contacts_;
};

}  // namespace

void add_contacts(const Solid& a, const Solid& b, std::pair<int, int> index, double dt,
                  BodyGeometry& geometry, std::vector<BodyContact>& contacts) {
  BodyMeeting(a, b, index, dt, contacts).look(geometry);
}

}  // namespace weft
