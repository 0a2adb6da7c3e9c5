#include "cloth/contact/constraints/contact_constraints.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "cloth/contact/recovery/node_contact.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

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
  yielding_.clear();
  substep_ = substep;
  const double h = substep.seconds;
  const kernels::Components<const Real> position = kernels::components(particles.position),
                                        velocity = kernels::components(particles.velocity);
  // `surface` as it will be beside the node if both go on as they go.
  const auto holding = [&](const Touch& touch, const Solid& solid, const Surface& surface) {
    const ClothPoint<Real> point(touch.point(), particles);
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
    const Surface surface = way_out_of(solid->placed(substep.to), touch.point(), guess, particles.position);
    // Where the solid or the node leaves, faster than gravity could bring them together again, nothing holds;
    // what lies on a body is held all the same, as springs may bring it back, and is let go if it pulls.
    const double reach = solid->yields() ? inner_radius(solid->shape) : touching_distance(h);
    if (surface.distance <= reach) {
      constraints_.push_back(holding(touch, *solid, surface));
    } else if (lay_on(*solid, place) && !flies_through(*solid, place, guess)) {
      not_held_.push_back(touch);
    }
  }
  const auto touching = static_cast<std::ptrdiff_t>(constraints_.size());
  for (const Arrival& arrival : arrivals) {
    const auto end = constraints_.begin() + touching;
    const auto same = std::lower_bound(constraints_.begin(), end, arrival.touch, is_before);
    const Solid& solid = solids[arrival.solid];
    if (same == end || same->touch != arrival.touch) {
      constraints_.push_back(holding(arrival.touch, solid, arrival.surface));
    } else if (solid.yields_turning()) {
      // Past an edge the face that it goes into, not the one that it would be nearest to inside.
      *same = holding(arrival.touch, solid, arrival.surface);
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
auto ContactConstraints<Real>::held_by(const Touch& touch, const ClothPoint<Real>& point, const Solid& solid,
                                       const Surface& surface, const Vec3& place, const Vec3& way) const
    -> Constraint {
  const auto same = std::lower_bound(last_.begin(), last_.end(), touch, is_before);
  const bool held = same != last_.end() && same->touch == touch;
  const double holds = held ? solid.friction * same->usual_force() : 0.0;
  const Vec3 move = solid.move_of(place, substep_.from, substep_.to), slip = way - move;
  const Vec3& normal = surface.normal;
  const double slid = across(slip, normal).norm();
  Constraint made{touch,
                  point,
                  std::nullopt,
                  Vec3(0, 0, 0),
                  normal,
                  normal.dot(way) - surface.distance,
                  solid.depth(place, substep_.from),
                  move,
                  holds,
                  slid,
                  slid,
                  inner_radius(solid.shape),
                  -normal.dot(slip) / substep_.seconds};
  if (held) {
    made.last_force = same->force;
    made.force_before = same->last_force;
  }
  made.has_stuck = held && (same->has_stuck || same->sticks());
  if (made.has_stuck) {
    made.speeding_up = speeding_up(*same, slid, holds, point.mass());
    made.sliding += std::max(0.0, std::min(made.speeding_up, same->speeding_up));
  }
  if (held) {
    made.gained_before = same->gained;
    // Friction in proportion to the slip would grow with what it gains on the last one.
    if (!made.has_stuck && !solid.yields())
      made.sliding += std::max(0.0, std::min(same->gained, same->gained_before));
  }
  if (held && near_rest_) made.grip = across(same->grip, normal);
  if (made.grip.squaredNorm() > holds * holds) made.grip.setZero();
  return made;
}

/// Median of this step's force and the last two. A step is solved as accurately as its motion needs, and a
/// contact is so stiff that a single force may be many times too large.
template <class Real>
double ContactConstraints<Real>::Constraint::usual_force() const {
  if (last_force < 0) return force;
  if (force_before < 0) return std::min(force, last_force);
  return std::max(std::min(force, last_force), std::min(std::max(force, last_force), force_before));
}

/// Friction is taken in proportion to the slip that is expected (add_to). By the last slip alone a node that
/// has stuck would begin to slip only as fast as its tiny slip can grow: a sheet on a slope of 30 degrees
/// whose friction falls from 0.8 to 0.2 stayed for another 0.18 s, with this for 0.03 s. No step's pull is
/// trusted alone: a sheet that friction of 0.3 holds on a slope of 15 degrees would creep by 4 mm/s. Where a
/// node has only slid, the last slip's little too much makes up for its first step, which knows of no force:
/// without, a sheet that begins to slide is ahead by 14 % after a second (T14).
template <class Real>
double ContactConstraints<Real>::speeding_up(const Constraint& last, double slid, double holds,
                                             double mass) const {
  if (slid == 0) return 0;  // stopped since then (settle): what pulled at it is no measure of what will
  const double h = substep_.seconds;
  return slid - last.slid + (last.grip.norm() - holds) * h * h / mass;
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
bool ContactConstraints<Real>::hold_inside(const std::vector<Touch>& inside, const Particles<Real>& particles,
                                           const std::vector<Solid>& solids,
                                           kernels::Components<const Real> move, AttachedBodies<Real>& bodies,
                                           double links_stiffness, double missed) {
  const kernels::Components<const Real> position = kernels::components(particles.position);
  std::vector<Constraint> more;
  double energy = 0;
  for (const Touch& touch : inside) {
    const Solid& solid = solid_of(touch, solids);
    const ClothPoint<Real> point(touch.point(), particles);
    const Vec3 place = point.of(position), way = point.moved_by(move);
    const Surface surface = way_out_of(solid.placed(substep_.to), touch.point(), place, particles.position);
    if (holds_already(touch, surface.normal)) continue;
    energy += links_stiffness * surface.distance * surface.distance / 2;
    Constraint made = held_by(touch, point, solid, surface, place - way, way);
    made.body = body_of(solid, solids, bodies);
    if (made.body) {
      made.arm = place - surface.distance * surface.normal - solid.at(substep_.to);
      const Vec3 gone = bodies.move(*made.body, made.arm);
      made.distance -= made.normal.dot(gone);
      made.solid_move -= gone;
    }
    more.push_back(made);
  }
  if (energy <= missed) return false;
  constraints_.insert(constraints_.end(), more.begin(), more.end());
  sort_by_touch();
  return true;
}

template <class Real>
bool ContactConstraints<Real>::let_go_of_slid_off(const Particles<Real>& particles,
                                                  const std::vector<Solid>& solids,
                                                  kernels::Components<const Real> move,
                                                  const AttachedBodies<Real>& bodies) {
  const kernels::Components<const Real> position = kernels::components(particles.position);
  const std::size_t before = not_held_.size();
  for (const Constraint& c : constraints_) {
    if (c.released) continue;
    const Vec3 way = move_of(c, move, bodies);
    if (!((way - c.solid_move).squaredNorm() > c.width * c.width)) continue;
    const Solid& solid = solid_of(c.touch, solids);
    const Vec3 start = c.point.of(position) - c.point.moved_by(move);
    const bool off = !solid.placed(substep_.to).may_touch(start + way, kSlidOff * c.width);
    if (off && lay_on(solid, start)) not_held_.push_back(c.touch);
  }
  if (not_held_.size() == before) return false;
  std::sort(not_held_.begin(), not_held_.end());
  std::erase_if(constraints_, [&](const Constraint& c) {
    return std::binary_search(not_held_.begin(), not_held_.end(), c.touch);
  });
  return true;
}

template <class Real>
void ContactConstraints<Real>::let_go_of_pinched(kernels::Components<const Real> velocity) {
  const auto room = [&](const Constraint& c) {
    return substep_.seconds * c.normal.dot(c.point.moved_by(velocity)) - c.distance;
  };
  const auto pinched = [&](const Constraint& a, const Constraint& b) {
    return !a.body && !b.body && a.normal.dot(b.normal) <= kFacing && room(a) + room(b) < 0;
  };
  // Of two that stand still the one it is less deep in: there it was held while the other came.
  const auto moves_least = [&](const Constraint& a, const Constraint& b) {
    return std::pair(a.solid_move.squaredNorm(), -room(a)) < std::pair(b.solid_move.squaredNorm(), -room(b));
  };
  std::vector<Constraint> kept;
  for (auto node = constraints_.begin(); node != constraints_.end();) {
    const auto end = std::find_if(node, constraints_.end(), [&](const Constraint& c) {
      return c.touch.point() != node->touch.point();
    });
    const bool stuck = std::any_of(node, end, [&](const Constraint& a) {
      return std::any_of(node, end, [&](const Constraint& b) { return pinched(a, b); });
    });
    if (stuck) {
      kept.push_back(*std::min_element(node, end, moves_least));
      kept.back().pinched = true;
    } else {
      kept.insert(kept.end(), node, end);
    }
    node = end;
  }
  constraints_.swap(kept);
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

template <class Real>
std::optional<int> ContactConstraints<Real>::body_of(const Solid& solid, const std::vector<Solid>& solids,
                                                     AttachedBodies<Real>& bodies) {
  if (!solid.yields()) return {};
  const auto index = static_cast<std::size_t>(&solid - solids.data());
  const auto known = std::find(yielding_.begin(), yielding_.end(), index);
  if (known != yielding_.end()) return static_cast<int>(known - yielding_.begin());
  yielding_.push_back(index);
  const double h = substep_.seconds, inertia = 1 / (solid.inverse_mass * h * h);
  if (!solid.yields_turning()) return bodies.add(inertia);
  return bodies.add(inertia, solid.inverse_inertia.inverse() / (h * h));
}

template class ContactConstraints<float>;
template class ContactConstraints<double>;

}  // namespace weft
