#include "cloth/contact/recovery/node_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft {
namespace {

/// Projections onto one solid after another before a node between overlapping solids is led straight out of
/// all of them.
constexpr int kProjections = 4;
/// A direction shorter than this part of a unit vector is none.
constexpr double kNoDirection = 1e-6;

}  // namespace

template <class Real>
bool NodeContact<Real>::resolve(std::vector<MovingSolid>& solids, std::vector<Touch>& touches) {
  const std::size_t touches_before = touches.size();
  bool met = stop_at_first(solids, touches);
  const Vec3 came = position_;
  std::vector<Found> found;  // one entry a solid
  for (int round = 0; round < kProjections; ++round) {
    bool moved = false;
    for (const std::size_t i : may_meet_) {
      MovingSolid& moving = solids[i];
      if (!moving.shape.contains(position_)) continue;
      const Surface surface = way_out_of(moving.shape, id_, position_, particles_.position);
      const double held = lose_velocity(moving, surface.normal);
      put_on(moving, surface);
      const double most = slip_is_left_ ? -moving.solid->friction * surface.distance
                                        : std::numeric_limits<double>::infinity();
      if (held > 0) slide_back(moving, held, most);
      moved = met = true;
      if (round == 0) touches.push_back(touch(*moving.solid));
      if (may_meet_.size() > 1) note(found, i, surface.normal);
    }
    if (!moved || may_meet_.size() == 1) return met;  // outside the only solid there is
  }
  if (const std::optional<std::size_t> still = pinching(found, solids, came)) {
    touches.resize(touches_before);
    touches.push_back(touch(*solids[*still].solid));
    set_position(came);  // the solids have handed it to one another, sideways
    hold_at(solids[*still]);
  } else {
    lead_out(solids, found);
  }
  return true;
}

template <class Real>
void NodeContact<Real>::note(std::vector<Found>& found, std::size_t solid, const Vec3& normal) {
  const auto same =
      std::find_if(found.begin(), found.end(), [&](const Found& f) { return f.solid == solid; });
  if (same == found.end()) {
    found.push_back({solid, normal});
  } else {
    same->normal = normal;
  }
}

/// Of solids that face each other with the node between them the one that moves least, of two that stand
/// still the one it is less deep in where it `came`; none if there are no such.
template <class Real>
std::optional<std::size_t> NodeContact<Real>::pinching(const std::vector<Found>& found,
                                                       const std::vector<MovingSolid>& solids,
                                                       const Vec3& came) {
  const auto move_and_depth = [&](std::size_t solid) {
    return std::pair(solids[solid].move.squaredNorm(), -solids[solid].shape.surface(came).distance);
  };
  std::optional<std::size_t> still;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = i + 1; j < found.size(); ++j) {
      if (found[i].normal.dot(found[j].normal) > kFacing) continue;
      for (const std::size_t each : {found[i].solid, found[j].solid}) {
        if (!still || move_and_depth(each) < move_and_depth(*still)) still = each;
      }
    }
  }
  return still;
}

/// Two solids cannot both be kept out of where they overlap: the node stays on this one's surface and goes
/// with it, however deep it is in the others.
template <class Real>
void NodeContact<Real>::hold_at(MovingSolid& still) {
  const Surface surface = still.shape.surface(position_);
  put_on(still, surface);
  part_with(velocity() - still.velocity_at(position_), still);
  set_velocity(still.velocity_at(position_));
}

/// Where the node's way first meets the solid, as seen from where that ends up. Seen from one that turns the
/// way is an arc, looked at in short chords.
template <class Real>
auto NodeContact<Real>::first_meeting(const MovingSolid& moving) const -> std::optional<Meeting> {
  const int chords = moving.chords();
  Vec3 from = position_ - move_ + moving.move_of(start_, 0);
  if (moving.shape.contains(from)) return {};
  const double square = (position_ - from).squaredNorm();
  if (square < moving.grazing * moving.grazing) return {};
  if (chords == 1 && !moving.shape.may_touch(from, std::sqrt(square))) return {};
  for (int chord = 1; chord <= chords; ++chord) {
    const double share = static_cast<double>(chord) / chords;
    const Vec3 place = start_ + share * move_;
    const Vec3 to = chord == chords ? position_ : Vec3(place + moving.move_of(place, share));
    if (const std::optional<Hit> hit = moving.shape.first_hit(from, to)) {
      return Meeting{(chord - 1 + hit->fraction) / chords, from + hit->fraction * (to - from), hit->normal};
    }
    from = to;
  }
  return {};
}

/// Nothing holds it to the solid, and it is drawn past and well away from it: off its side, and on.
template <class Real>
bool NodeContact<Real>::slides_off(const MovingSolid& moving) const {
  if (!std::binary_search(not_held_.begin(), not_held_.end(), touch(*moving.solid))) return false;
  return is_off_side(moving.shape, position_);
}

/// Where the node's way meets a fast solid: it stays at the surface from there on, and slides.
template <class Real>
bool NodeContact<Real>::stop_at_first(std::vector<MovingSolid>& solids, std::vector<Touch>& touches) {
  std::optional<Meeting> first;
  std::size_t which = 0;
  for (const std::size_t i : may_meet_) {
    if (!solids[i].fast) continue;
    if (std::binary_search(kept_aside_.begin(), kept_aside_.end(), touch(*solids[i].solid))) continue;
    const std::optional<Meeting> meeting = first_meeting(solids[i]);
    if (!meeting || (first && first->fraction <= meeting->fraction)) continue;
    if (slides_off(solids[i])) {
      touches.push_back(touch(*solids[i].solid));
      continue;
    }
    first = meeting;
    which = i;
  }
  if (!first) return false;

  MovingSolid& moving = solids[which];
  const Vec3 rest = position_ - first->place, normal = first->normal;
  const double inward = rest.dot(normal);
  const Vec3 along = rest - inward * normal;
  const double slide = along.norm();
  const double held = slide > 0 ? std::min(1.0, std::max(0.0, -moving.solid->friction * inward) / slide) : 0;
  lose_velocity(moving, normal);
  const Vec3 end = first->place + (1 - held) * along;
  put_outside(moving.shape, end, normal, std::max(0.0, -moving.shape.surface(end).distance));
  touches.push_back(touch(*moving.solid));
  return true;
}

/// Friction takes back `share` of the way slid from where the node began, put at the same height, and `most`,
/// m, at most: from surface to surface, as a node that is held whole would creep against what pulls it if it
/// were led back along the tangent plane at a place that it does not reach.
template <class Real>
void NodeContact<Real>::slide_back(const MovingSolid& moving, double share, double most) {
  const Vec3 began = start_ + moving.move_of(start_, 0);
  const Surface first = moving.shape.surface(began), last = moving.shape.surface(position_);
  const Vec3 back = began + (last.distance - first.distance) * first.normal - position_;
  const double slid = back.norm();
  if (slid > 0) set_position(position_ + std::min(share, most / slid) * back);
  put_on(moving, moving.shape.surface(position_));
}

/// Takes away the velocity, relative to the solid's, that points against `normal`, and what friction then
/// takes of the rest. Returns the share of the node's slide that this takes.
template <class Real>
double NodeContact<Real>::lose_velocity(MovingSolid& moving, const Vec3& normal) {
  const Vec3 velocity = this->velocity(), relative = velocity - moving.velocity_at(position_);
  const double inward = relative.dot(normal);
  if (!(inward < 0)) return 0;
  const Vec3 stopped = inward * normal, sliding = relative - stopped;
  const double speed = moving.solid->friction > 0 ? sliding.norm() : 0.0;
  const double held = speed > 0 ? std::min(1.0, -moving.solid->friction * inward / speed) : 0.0;
  const Vec3 lost = stopped + held * sliding;
  const double share = part_with(lost, moving);
  set_velocity(velocity - share * lost);
  return share * held;
}

/// The solid takes up the momentum of a velocity `lost` between the two, at the node, so that this loss is
/// shared by their inverse masses there: an impulse along what is lost, so that with no friction it is along
/// the normal, and with it in friction's cone; it never adds energy. Returns the node's share: all of it, to
/// the bit, where the solid does not yield.
template <class Real>
double NodeContact<Real>::part_with(const Vec3& lost, MovingSolid& moving) {
  const Solid& solid = *moving.solid;
  if (!solid.yields()) return 1;
  const double mass = point_.mass(), ratio = mass * solid.inverse_mass;
  if (!solid.yields_turning()) {
    const double share = 1 / (1 + ratio);
    moving.velocity += ratio * share * lost;
    return share;
  }
  const Vec3 arm = position_ - moving.shape.centre;
  const double share = 1 / (1 + mass * solid.inverse_mass_at(arm, lost.stableNormalized()));
  moving.velocity += ratio * share * lost;
  moving.spin += solid.inverse_inertia * arm.cross(mass * share * lost);
  return share;
}

/// Overlapping solids hand a node to each other. Along one ray none but a mesh is entered twice, if the ray
/// leads away from half-spaces, and a mesh not for ever.
template <class Real>
void NodeContact<Real>::lead_out(const std::vector<MovingSolid>& solids, const std::vector<Found>& found) {
  Vec3 direction(0, 0, 0);
  for (const Found& each : found) direction += each.normal;
  for (const std::size_t i : may_meet_) {
    const MovingSolid& moving = solids[i];
    if (!std::holds_alternative<HalfSpace>(moving.shape.shape)) continue;
    const Surface surface = moving.shape.surface(position_);
    direction -= std::min(0.0, direction.dot(surface.normal)) * surface.normal;
    put_outside(moving.shape, position_, surface.normal, std::max(0.0, -surface.distance));
    if (direction.norm() < kNoDirection) direction = surface.normal.unitOrthogonal();
  }
  direction = direction.norm() < kNoDirection ? Vec3(0, 1, 0) : direction.normalized();
  for (bool moved = true; moved;) {
    moved = false;
    for (const std::size_t i : may_meet_) {
      const MovingSolid& moving = solids[i];
      if (!moving.shape.contains(position_)) continue;
      const double way = moving.shape.way_out(position_, direction);
      if (!std::isfinite(way)) continue;  // rounding put it back: the next step's projections lift it
      put_outside(moving.shape, position_, direction, way);
      moved = true;
    }
  }
}

/// To the point of the surface next to it, of a ball as the paper has it, from the centre.
template <class Real>
void NodeContact<Real>::put_on(const MovingSolid& moving, const Surface& surface) {
  const PlacedShape& shape = moving.shape;
  const auto* sphere = std::get_if<Sphere>(&shape.shape);
  if (sphere != nullptr && !id_.between_nodes()) {
    put_outside(shape, shape.centre, surface.normal, sphere->radius);
  } else {
    put_outside(shape, position_, surface.normal, -surface.distance);
  }
}

/// To from + distance * direction, and beyond it by what rounding may take back, so that it ends up outside.
template <class Real>
void NodeContact<Real>::put_outside(const PlacedShape& shape, const Vec3& from, const Vec3& direction,
                                    double distance) {
  double margin = (from.cwiseAbs().sum() + std::max(distance, (from - shape.centre).norm()) + distance) *
                  double(std::numeric_limits<Real>::epsilon()) / 2;
  // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): it may be position_, and that goes.
  const Vec3 begin = from;
  do {
    set_position(begin + (distance + margin) * direction);
    margin *= 2;
  } while (shape.contains(position_));
}

template <class Real>
void NodeContact<Real>::set_position(const Vec3& target) {
  const Vec3 change = target - position_;
  point_.for_each_gain([&](std::size_t node, double gain) {
    const Vec3 place = at(kernels::components(std::as_const(particles_.position)), node);
    const Vec3 wanted = id_.between_nodes() ? Vec3(place + gain * change) : target;
    set(particles_.position, node, wanted);
    if (rounded_off_ == nullptr) return;
    set(*rounded_off_, node, wanted - at(kernels::components(std::as_const(particles_.position)), node));
  });
  position_ = point_.of(kernels::components(std::as_const(particles_.position)));
}

template <class Real>
void NodeContact<Real>::set_velocity(const Vec3& velocity) {
  if (id_.between_nodes()) {
    point_.shift(kernels::components(particles_.velocity), velocity - this->velocity());
  } else {
    set(particles_.velocity, id_.node, velocity);
  }
}

template class NodeContact<float>;
template class NodeContact<double>;

}  // namespace weft
