#include "cloth/bodies/body_collision.h"

#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

#include "cloth/bodies/body_geometry.h"
#include "cloth/bodies/contact_manifold.h"
#include "cloth/shapes/box_tree.h"
#include "cloth/shapes/triangle_mesh.h"

namespace weft {
namespace {

using Geometry = BodyGeometry::Geometry;
using Pair = std::pair<int, int>;

/// Of the smaller of two inner radii: what is nearer counts, as an impulse may bring it on; what moves
/// farther may have passed through.
constexpr double kBodyMargin = 0.5;
/// Of two solids' contacts these are enough to hold them.
constexpr std::size_t kMostContacts = 8;
/// Of the same margin: so far back on its way a pinned node is told which face it comes to.
constexpr double kSeenFrom = 0.03;
/// Of a body's outer radius: how strongly a surface must be curved for its nearest points to be kept, not its
/// farthest. A ball's is 1, a face has none.
constexpr double kRoundness = 2;

bool is_half_space(const Solid& solid) { return std::holds_alternative<HalfSpace>(solid.shape); }
bool is_ball(const Solid& solid) { return std::holds_alternative<Sphere>(solid.shape); }
bool is_pinned_node(const Solid& solid) { return inner_radius(solid.shape) == 0; }
const TriangleMesh* surface_of(const Solid& solid) {
  const auto* mesh = std::get_if<Mesh>(&solid.shape);
  return mesh == nullptr ? nullptr : mesh->surface;
}

/// One of the two is where it is for good.
bool is_firm(const Solid& a, const Solid& b) {
  const auto fixed = [](const Solid& solid) { return !solid.yields() && !solid.mobile; };
  return fixed(a) || fixed(b);
}

/// How far any of its points moves in the step at most, m.
double most_move(const Solid& solid) {
  const double way = (solid.position - solid.start).norm();
  return solid.turns() ? way + solid.turn.norm() * outer_radius(solid.shape) : way;
}

Eigen::AlignedBox3d swept_box(const Solid& solid) {
  Eigen::AlignedBox3d box = solid.placed(1).bounds().merged(solid.placed(0).bounds());
  double more = kBodyMargin * inner_radius(solid.shape);
  if (solid.turns()) more += solid.turn.norm() * outer_radius(solid.shape);
  return {box.min() - Vec3::Constant(more), box.max() + Vec3::Constant(more)};
}

bool add_overlap(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* pairs) {
  static_cast<std::vector<Pair>*>(pairs)->emplace_back(BoxTree::index_of(a), BoxTree::index_of(b));
  return false;  // go on
}

/// Two solids while their contacts are looked for.
class Meeting {
 public:
  Meeting(const Solid& a, const Solid& b, Pair pair, double dt, std::vector<BodyContact>& contacts)
      : index_(pair),
        a_(a),
        b_(b),
        margin_(kBodyMargin * std::min(half_width(a_), half_width(b_))),
        dt_(dt),
        contacts_(contacts) {}

  const Solid& a() const { return a_; }
  const Solid& b() const { return b_; }
  /// Where it ends says nothing of where it came from. What is next to a node that has come in by a little at
  /// a body's edge may be another face than the one it came through.
  bool looked_at_on_its_way() const {
    return is_pinned_node(b_) || (!is_half_space(b_) && most_move(a_) + most_move(b_) > margin_);
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
    if (!result.isCollision()) return;
    const fcl::Contactd& deepest = result.getContact(0);
    if (!(deepest.normal.squaredNorm() > 0.5)) return;  // of two shapes that touch by rounding it has none
    const Manifold manifold =
        manifold_of(a_.placed(1), b_.placed(1), deepest.normal.normalized(), deepest.pos, margin_);
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
      const Vec3 normal = b.surface(place).normal - a.surface(place).normal;
      if (!place.allFinite() || !(normal.norm() > 0.1)) continue;
      const Vec3 arm_a = place - a_.position, arm_b = place - b_.position;
      const Vec3 move = move_of(in_the_middle(a_, arm_a, 1), in_the_middle(b_, arm_b, 1));
      add(arm_a, arm_b, normal.normalized(), normal.normalized().dot(move));
    }
  }

 private:
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
    constexpr double kInwards = 0.2;
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
  /// over an edge would be told, of the second, that it was in before.
  static Vec3 in_the_middle(const Solid& solid, const Vec3& arm, double share) {
    if (!solid.turns()) return arm;
    return Eigen::AngleAxisd((0.5 - share) * solid.turn.norm(), solid.turn.stableNormalized()) * arm;
  }
  /// The arms at `share` of the step; `end` is the gap at its end.
  void add(const Vec3& arm_a, const Vec3& arm_b, const Vec3& normal, double end, double share = 1) {
    const Vec3 middle_a = in_the_middle(a_, arm_a, share), middle_b = in_the_middle(b_, arm_b, share);
    contacts_.push_back({index_.first, index_.second, middle_a, middle_b, normal,
                         end - normal.dot(move_of(middle_a, middle_b)), std::sqrt(a_.friction * b_.friction),
                         is_firm(a_, b_)});
  }

  Pair index_;
  const Solid &a_, &b_;
  double margin_, dt_;
  std::vector<BodyContact>& contacts_;
};

/// Of the contacts from `first` on keeps the deepest and then, again and again, the one that is farthest from
/// all that is kept: of squared distance counts what is more than `width`, m, times what its gap is wider
/// than the deepest's. With none a face is held at its corners, with one what is round by what is right below
/// it.
void thin_out(std::vector<BodyContact>& contacts, std::size_t first, double width) {
  const auto begin = contacts.begin() + static_cast<std::ptrdiff_t>(first);
  if (contacts.size() - first <= kMostContacts) return;
  const auto deepest = std::min_element(
      begin, contacts.end(), [](const BodyContact& p, const BodyContact& q) { return p.gap < q.gap; });
  std::iter_swap(begin, deepest);
  for (std::size_t kept = 1; kept < kMostContacts; ++kept) {
    const auto end = begin + static_cast<std::ptrdiff_t>(kept);
    const auto worth = [&](const BodyContact& c) {
      double nearest = (c.arm_a - begin->arm_a).squaredNorm();
      for (auto k = begin; k != end; ++k) nearest = std::min(nearest, (c.arm_a - k->arm_a).squaredNorm());
      return nearest - width * (c.gap - begin->gap);
    };
    std::iter_swap(end, std::max_element(end, contacts.end(),
                                         [&](const auto& p, const auto& q) { return worth(p) < worth(q); }));
  }
  contacts.resize(first + kMostContacts);
}

}  // namespace

struct BodyCollision::Impl {
  /// The pairs that may meet, one of each yields, a half-space or a pinned node second, in the order of
  /// `find`.
  bool find_pairs(const std::vector<Solid>& solids, const std::vector<PinnedNode>& pins) {
    pairs.clear();
    bounded.clear();
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if (is_half_space(solids[i])) continue;
      const Eigen::AlignedBox3d box = swept_box(solids[i]);
      if (!box.min().allFinite() || !box.max().allFinite()) return false;
      bounded.push_back(static_cast<int>(i));
    }
    tree.resize(bounded.size());
    for (std::size_t i = 0; i < bounded.size(); ++i) {
      tree.set(i, swept_box(solids[static_cast<std::size_t>(bounded[i])]));
    }
    tree.update();
    tree.manager().collide(&pairs, add_overlap);
    for (Pair& pair : pairs) {
      pair = std::minmax(bounded[static_cast<std::size_t>(pair.first)],
                         bounded[static_cast<std::size_t>(pair.second)]);
    }
    for (const int i : bounded) {
      for (std::size_t j = 0; j < solids.size(); ++j) {
        if (is_half_space(solids[j])) pairs.emplace_back(i, static_cast<int>(j));
      }
    }
    for (std::size_t i = 0; i < pins.size(); ++i) {
      pairs.emplace_back(static_cast<int>(pins[i].solid), static_cast<int>(solids.size() + i));
    }
    const auto solid = [&](int i) -> const Solid& { return of(i, solids, pins); };
    std::erase_if(pairs,
                  [&](const Pair& p) { return !solid(p.first).yields() && !solid(p.second).yields(); });
    const auto firmness = [&](const Pair& p) {
      const Solid &a = solid(p.first), &b = solid(p.second);
      return is_firm(a, b) ? 2 : a.yields() && b.yields() ? 0 : 1;
    };
    std::sort(pairs.begin(), pairs.end(), [&](const Pair& p, const Pair& q) {
      return std::make_pair(firmness(p), p) < std::make_pair(firmness(q), q);
    });
    return true;
  }

  static const Solid& of(int index, const std::vector<Solid>& solids, const std::vector<PinnedNode>& pins) {
    const auto i = static_cast<std::size_t>(index);
    return i < solids.size() ? solids[i] : pins[i - solids.size()].node;
  }

  void look_at(Meeting& meeting) {
    const Solid &a = meeting.a(), &b = meeting.b();
    if (meeting.looked_at_on_its_way() && meeting.sweep()) return;
    if (is_half_space(b) || is_ball(a)) {
      meeting.look_at_corners(false);
    } else if (is_ball(b)) {
      meeting.look_at_corners(true);
    } else if (is_convex(a.shape) && is_convex(b.shape)) {
      meeting.look_at_faces(geometry.of(a), geometry.of(b));
    } else {
      meeting.look_at_corners(false);
      meeting.look_at_corners(true);
      meeting.look_at_crossings(geometry.of(a), geometry.of(b));
    }
  }

  BoxTree tree;
  std::vector<int> bounded;  ///< solids in the tree
  std::vector<Pair> pairs;
  BodyGeometry geometry;
  std::vector<BodyContact> contacts;
};

BodyCollision::BodyCollision() : impl_(std::make_unique<Impl>()) {}
BodyCollision::~BodyCollision() = default;

const std::vector<BodyContact>& BodyCollision::find(const std::vector<Solid>& solids, double dt,
                                                    const std::vector<PinnedNode>& pins) {
  std::vector<BodyContact>& contacts = impl_->contacts;
  contacts.clear();
  if (!impl_->find_pairs(solids, pins)) return contacts;
  // All pinned nodes beside a body are one thing that holds it.
  const auto same = [&](const Pair& p, const Pair& q) {
    const int count = static_cast<int>(solids.size());
    return p.first == q.first && std::min(p.second, count) == std::min(q.second, count);
  };
  for (auto begin = impl_->pairs.begin(), end = begin; begin != impl_->pairs.end(); begin = end) {
    end = std::find_if(begin, impl_->pairs.end(), [&](const Pair& p) { return !same(*begin, p); });
    const std::size_t first = contacts.size();
    const Solid& a = solids[static_cast<std::size_t>(begin->first)];
    for (const Pair& pair : std::span(begin, end)) {
      Meeting meeting(a, Impl::of(pair.second, solids, pins), pair, dt, contacts);
      impl_->look_at(meeting);
    }
    const bool pinned = is_pinned_node(Impl::of(begin->second, solids, pins));
    thin_out(contacts, first, pinned ? kRoundness * 2 * outer_radius(a.shape) : 0);
  }
  return contacts;
}

}  // namespace weft
