#include "cloth/contact/constraints/contact_constraints.h"

#include <algorithm>
#include <utility>

#include "cloth/contact/recovery/node_contact.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Cosine of the angle by which a surface turns at most between where a node begins and where a plane holds
/// it: 26 degrees. On a ball that is turned by so much the node begins a tenth of the radius behind the
/// plane.
constexpr double kTurned = 0.9;

/// What is nearer lies on a solid: gravity could bring them together again, m.
double touching_distance(double seconds) { return standard_gravity().norm() * seconds * seconds; }

}  // namespace

template <class Real>
void ContactConstraints<Real>::begin(const std::vector<Touch>& touches, const std::vector<Arrival>& arrivals,
                                     const Particles<Real>& particles, const std::vector<Solid>& solids,
                                     const Substep& substep, bool near_rest, AttachedBodies<Real>& bodies) {
  near_rest_ = near_rest;
  std::swap(last_, constraints_);
  clear();
  bodies.clear();
  substep_ = substep;
  const double h = substep.seconds;
  const kernels::Components<const Real> position = kernels::components(particles.position),
                                        velocity = kernels::components(particles.velocity);
  // `surface` as it will be beside the node if both go on as they go.
  const auto holding = [&](const Touch& touch, const ClothPoint<Real>& point, const Solid& solid,
                           const Surface& surface) {
    const Vec3 place = point.of(position), way = h * point.moved_by(velocity);
    Constraint made = held_by(touch, point, solid, surface, place, way);
    made.body = body_of(solid, solids, bodies);
    if (solid.yields_turning())
      made.arm = place + way - surface.distance * surface.normal - solid.at(substep.to);
    return made;
  };
  // Pressed onto a solid they touch it, be they outside by a hair.
  std::vector<Touch> all = touches;
  for (const Constraint& c : last_) {
    if (c.force > 0) all.push_back(c.touch);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const Touch& touch : all) {
    const auto solid =
        std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.id == touch.collider; });
    if (solid == solids.end()) continue;
    const ClothPoint<Real> point(touch.point(), particles);
    const Vec3 place = point.of(position), guess = place + h * point.moved_by(velocity);
    const Surface surface =
        as_before(touch, *solid,
                  way_out_of(solid->placed(substep.to), touch.point(), guess, particles.position), guess);
    // Where the solid or the node leaves, faster than gravity could bring them together again, nothing holds;
    // what lies on a body is held all the same, as springs may bring it back, and is let go if it pulls.
    const double reach = solid->yields() ? inner_radius(solid->shape) : touching_distance(h);
    if (surface.distance <= reach) {
      if (const std::optional<Surface> plane = plane_for(*solid, surface, place, guess))
        constraints_.push_back(holding(touch, point, *solid, *plane));
    } else if (lay_on(*solid, place) && !flies_through(*solid, place, guess)) {
      not_held_.push_back(touch);
    }
  }
  const auto touching = static_cast<std::ptrdiff_t>(constraints_.size());
  for (const Arrival& arrival : arrivals) {
    const auto end = constraints_.begin() + touching;
    const auto same = std::lower_bound(constraints_.begin(), end, arrival.touch, is_before);
    const Solid& solid = solids[arrival.solid];
    const ClothPoint<Real> point(arrival.touch.point(), particles);
    if (same == end || same->touch != arrival.touch) {
      constraints_.push_back(holding(arrival.touch, point, solid, arrival.surface));
    } else if (solid.yields_turning()) {
      // Past an edge the face that it goes into, not the one that it would be nearest to inside.
      *same = holding(arrival.touch, point, solid, arrival.surface);
    }
  }
  if (!arrivals.empty()) {
    sort_by_touch();
  }
  if (solids.size() > 1) let_go_of_pinched(velocity);
}

template <class Real>
bool ContactConstraints<Real>::is_before(const Constraint& c, const Touch& touch) {
  return c.touch < touch;
}

template <class Real>
void ContactConstraints<Real>::sort_by_touch() {
  std::sort(constraints_.begin(), constraints_.end(),
            [](const Constraint& a, const Constraint& b) { return a.touch < b.touch; });
}

template <class Real>
std::optional<Surface> ContactConstraints<Real>::plane_for(const Solid& solid, const Surface& near,
                                                           const Vec3& place, const Vec3& end) const {
  const PlacedShape shape = solid.placed(substep_.to);
  const Vec3 begin = place + solid.move_of(place, substep_.from, substep_.to), way = end - begin;
  const Surface first = shape.surface(begin);
  if (first.normal.dot(near.normal) >= kTurned) return near;
  if (first.distance <= 0 && solid.yields()) return near;
  if (first.distance <= 0) return Surface{first.distance + first.normal.dot(way), first.normal};
  const std::optional<Hit> hit = shape.first_hit(begin, end);
  if (!hit) return solid.yields() ? std::optional(near) : std::nullopt;
  return Surface{(1 - hit->fraction) * hit->normal.dot(way), hit->normal};
}

template <class Real>
Surface ContactConstraints<Real>::as_before(const Touch& touch, const Solid& solid, const Surface& near,
                                            const Vec3& end) const {
  if (!solid.yields_turning() || -near.distance <= touching_distance(substep_.seconds)) return near;
  const Constraint* same = as_last(touch);
  if (same == nullptr || same->released) return near;
  const PlacedShape shape = solid.placed(substep_.to);
  const Vec3 normal = shape.rotation * same->face;
  if (near.normal.dot(normal) >= kTurned) return near;
  const double out = shape.way_out(end, normal);
  return out <= inner_radius(solid.shape) ? Surface{-out, normal} : near;
}

template <class Real>
auto ContactConstraints<Real>::held_by(const Touch& touch, const ClothPoint<Real>& point, const Solid& solid,
                                       const Surface& surface, const Vec3& place, const Vec3& way) const
    -> Constraint {
  const Constraint* same = as_last(touch);
  const Vec3 move = solid.move_of(place, substep_.from, substep_.to), slip = way - move;
  const Vec3& normal = surface.normal;
  const double bears_from = solid.yields() ? 0 : margin();
  const double gap = solid.gap(place, substep_.from);
  Constraint made{touch,
                  point,
                  std::nullopt,
                  Vec3(0, 0, 0),
                  normal,
                  normal.dot(way) - surface.distance + bears_from,
                  0,
                  normal.dot(slip) - (surface.distance - gap),
                  move,
                  inner_radius(solid.shape),
                  solid.placed(substep_.to).rotation.transpose() * normal};
  // What meets it anew is led out to where the spring begins to bear, at no speed.
  made.led_out = std::max(0.0, (same != nullptr ? 0 : bears_from) - gap);
  if (solid.yields()) {
    // A solid that yields is led out of the cloth as well, by the same spring, and keeps the speed.
    const double slowly = std::min(made.led_out, depth());
    made.distance -= made.led_out - slowly;
    made.led_out = slowly;
  }
  made.coefficient = solid.friction;
  const double pressed_in = solid.yields() ? 0 : std::max(0.0, made.distance - normal.dot(way));
  made.friction = SurfaceFriction(across(slip, normal), solid.friction * pressed_in);
  if (same != nullptr) {
    made.last_force = same->force;
    made.stiffness = same->stiffness;
    made.force_before = same->last_force;
    made.friction.go_on_from(same->friction);
    if (!solid.yields() || near_rest_) made.friction.keep_force_of(same->friction, normal);
  }
  return made;
}

/// This solid, or one that faces it, holds the node.
template <class Real>
bool ContactConstraints<Real>::holds_already(const Touch& touch, const Vec3& normal) const {
  const Touch first{touch.node, 0, touch.within};
  for (auto c = std::lower_bound(constraints_.begin(), constraints_.end(), first, is_before);
       c != constraints_.end() && c->touch.point() == touch.point(); ++c) {
    if (c->touch == touch || c->normal.dot(normal) <= kFacing) return true;
  }
  return false;
}

template <class Real>
bool ContactConstraints<Real>::hold_inside(const std::vector<Touch>& inside,
                                           const std::vector<Arrival>& passed,
                                           const Particles<Real>& particles, const std::vector<Solid>& solids,
                                           kernels::Components<const Real> move, AttachedBodies<Real>& bodies,
                                           double links_stiffness, double missed) {
  const kernels::Components<const Real> position = kernels::components(particles.position);
  std::vector<Constraint> more;
  double energy = 0;
  const auto hold = [&](const Touch& touch, const Solid& solid, const Surface& surface) {
    if (holds_already(touch, surface.normal)) return;
    const ClothPoint<Real> point(touch.point(), particles);
    const Vec3 place = point.of(position), way = point.moved_by(move);
    const std::optional<Surface> plane = plane_for(solid, surface, place - way, place);
    if (!plane) return;
    energy += links_stiffness * plane->distance * plane->distance / 2;
    Constraint made = held_by(touch, point, solid, *plane, place - way, way);
    made.body = body_of(solid, solids, bodies);
    if (made.body) {
      if (solid.yields_turning()) made.arm = place - plane->distance * plane->normal - solid.at(substep_.to);
      const Vec3 gone = bodies.move(*made.body, made.arm);
      made.distance -= made.normal.dot(gone);
      made.solid_move -= gone;
    }
    more.push_back(made);
  };
  for (const Arrival& arrival : passed) {
    const Solid& solid = solids[arrival.solid];
    const Vec3 place = ClothPoint<Real>(arrival.touch.point(), particles).of(position);
    const bool leaves = std::binary_search(not_held_.begin(), not_held_.end(), arrival.touch);
    if (!leaves || !is_off_side(solid.placed(substep_.to), place))
      hold(arrival.touch, solid, arrival.surface);
  }
  for (const Touch& touch : inside) {
    const Solid& solid = solid_of(touch, solids);
    const Vec3 place = ClothPoint<Real>(touch.point(), particles).of(position);
    const bool came_through =
        std::any_of(more.begin(), more.end(), [&](const Constraint& c) { return c.touch == touch; });
    if (came_through) continue;
    hold(touch, solid, way_out_of(solid.placed(substep_.to), touch.point(), place, particles.position));
  }
  if (energy <= missed) return false;
  constraints_.insert(constraints_.end(), more.begin(), more.end());
  sort_by_touch();
  return true;
}

template <class Real>
bool ContactConstraints<Real>::lay_on(const Solid& solid, const Vec3& place) const {
  return solid.placed(substep_.from).may_touch(place, touching_distance(substep_.seconds));
}

template <class Real>
bool ContactConstraints<Real>::flies_through(const Solid& solid, const Vec3& place, const Vec3& to) const {
  const PlacedShape shape = solid.placed(substep_.to);
  const Vec3 from = place + solid.move_of(place, substep_.from, substep_.to);
  return !shape.contains(from) && shape.first_hit(from, to).has_value();
}

template class ContactConstraints<float>;
template class ContactConstraints<double>;

}  // namespace weft
