#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cloth/contact/recovery/contact.h"

namespace weft {

/// Cosine of the angle between the normals of solids that face each other: 120 degrees or more.
inline constexpr double kFacing = -0.5;
/// Of a solid's inner radius: a node farther from it on a tangent plane has slid off its side, from a ball by
/// 1.1 radii.
inline constexpr double kSlidOff = 0.5;
/// What was drawn here along a tangent plane of the shape has slid off its side.
inline bool is_off_side(const PlacedShape& shape, const Vec3& place) {
  return !shape.may_touch(place, kSlidOff * inner_radius(shape.shape));
}

/// A solid in a substep.
struct MovingSolid {
  const Solid* solid;
  PlacedShape shape;  ///< at the substep's end
  Vec3 move;          ///< of its centre in the substep, m
  double sweep;       ///< the farthest that any of its points moves, m
  double reach;       ///< beyond its surface what of the nodes it may have met is no farther, m
  bool fast;          ///< nodes might pass through it unseen: their ways are looked at
  double grazing;     ///< m; but for those that go less, as seen from it: at most they cut an edge
  Vec3 velocity;      ///< with what the nodes so far gave it, m/s
  Vec3 spin;          ///< the same, rad/s
  Substep substep;
  RigidMove whole;  ///< in the substep

  /// Of what of it is at `point`, at the substep's end, m/s.
  Vec3 velocity_at(const Vec3& point) const {
    return spin.isZero(0) ? velocity : Vec3(velocity + spin.cross(point - shape.centre));
  }
  /// How far what is at `point` after that share of the substep goes with it until its end, m.
  Vec3 move_of(const Vec3& point, double share) const {
    if (share == 0) return whole.of(point);
    if (!solid->turns()) return (1 - share) * move;
    return solid->move_of(point, substep.from + share * (substep.to - substep.from), substep.to);
  }
  /// So many chords of a way seen from it differ from the arc by at most 1/800 of the distance from its axis.
  int chords() const {
    if (!solid->turns()) return 1;
    constexpr double kAngle = 0.1;      // rad
    constexpr double kMostChords = 63;  // a whole turn: what turns faster is looked at no more often
    return static_cast<int>(
        std::min(std::ceil((substep.to - substep.from) * solid->turn.norm() / kAngle), kMostChords));
  }
};

/// One free node, or a point between nodes, while its contacts in a substep are resolved. What moves a point
/// moves its nodes (ClothPoint).
template <class Real>
class NodeContact {
 public:
  struct State {
    Particles<Real>& particles;
    VectorField<Real>* rounded_off;  ///< or none (Contact::resolve)
    /// Friction has borne on the way: it left a slip of at most its coefficient times the depth it left, as
    /// contact springs are as stiff along the surface as across it (ContactConstraints).
    bool slip_is_left;
    const std::vector<Touch>& not_held;    ///< to what it lay on (Contact::let_slide_off)
    const std::vector<Touch>& kept_aside;  ///< Contact::trust
  };
  /// It may meet the solids with these indices, ascending; `move` is its own in the substep.
  NodeContact(const State& state, const PointId& id, std::span<const std::size_t> may_meet, const Vec3& move)
      : particles_(state.particles),
        rounded_off_(state.rounded_off),
        id_(id),
        point_(id, state.particles),
        may_meet_(may_meet),
        position_(point_.of(kernels::components(std::as_const(state.particles.position)))),
        start_(position_ - move),
        move_(move),
        slip_is_left_(state.slip_is_left),
        not_held_(state.not_held),
        kept_aside_(state.kept_aside) {}

  /// Brings the node out of all solids (pinched between two it stays with the one that moves least), and back
  /// from beyond those it passed through; those that yield get what it gives them, `touches` what it met.
  /// False if it met none.
  bool resolve(std::vector<MovingSolid>& solids, std::vector<Touch>& touches);

 private:
  Vec3 velocity() const { return point_.of(kernels::components(std::as_const(particles_.velocity))); }
  /// Of the node's way and a solid.
  struct Meeting {
    double fraction;  ///< of the way
    Vec3 place;       ///< as seen from where the solid ends up
    Vec3 normal;
  };
  std::optional<Meeting> first_meeting(const MovingSolid& moving) const;
  bool stop_at_first(std::vector<MovingSolid>& solids, std::vector<Touch>& touches);
  /// A solid the node was found in.
  struct Found {
    std::size_t solid;
    Vec3 normal;
  };
  bool slides_off(const MovingSolid& moving) const;
  static void note(std::vector<Found>& found, std::size_t solid, const Vec3& normal);
  static std::optional<std::size_t> pinching(const std::vector<Found>& found,
                                             const std::vector<MovingSolid>& solids, const Vec3& came);
  void hold_at(MovingSolid& still);
  double lose_velocity(MovingSolid& moving, const Vec3& normal);
  void slide_back(const MovingSolid& moving, double share, double most);
  double part_with(const Vec3& lost, MovingSolid& moving);
  void put_on(const MovingSolid& moving, const Surface& surface);
  void put_outside(const PlacedShape& shape, const Vec3& from, const Vec3& direction, double distance);
  void lead_out(const std::vector<MovingSolid>& solids, const std::vector<Found>& found);
  static void set(VectorField<Real>& field, std::size_t node, const Vec3& value) {
    weft::set(kernels::components(field), node, value);
  }
  void set_position(const Vec3& target);
  void set_velocity(const Vec3& velocity);
  Touch touch(const Solid& solid) const { return {id_.node, solid.id, id_.within}; }

  Particles<Real>& particles_;
  VectorField<Real>* rounded_off_;
  PointId id_;
  ClothPoint<Real> point_;
  std::span<const std::size_t> may_meet_;
  Vec3 position_, start_, move_;
  bool slip_is_left_;
  const std::vector<Touch>&not_held_, &kept_aside_;
};

extern template class NodeContact<float>;
extern template class NodeContact<double>;

}  // namespace weft
