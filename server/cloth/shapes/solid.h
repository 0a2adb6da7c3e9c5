#pragma once
#include <cstdint>

#include "cloth/shapes/shape.h"

namespace weft {

/// Of a ball (1, 2, ...) or an obstacle (kFirstObstacle, ...).
using ColliderId = std::uint32_t;
inline constexpr ColliderId kFirstObstacle = 0x8000'0000;

/// How what goes with a solid moves in a part of a step.
struct RigidMove {
  Vec3 shift{0, 0, 0};   ///< of its centre, m
  Vec3 centre{0, 0, 0};  ///< where that begins, m
  bool turns = false;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();

  /// How far a point goes that is at `point` as the part begins, m.
  Vec3 of(const Vec3& point) const {
    if (!turns) return shift;
    const Vec3 arm = point - centre;
    return shift + (turn * arm - arm);
  }
};

/// What a cloth meets in a step: a shape on a straight way, perhaps turning as it goes. One that yields is
/// the cloth's own copy: what the cloth gives it bends the way.
struct Solid {
  ColliderId id = 0;
  Shape shape;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< own axes in the world, at the step's end
  double friction = 0;                                     ///< Coulomb's coefficient
  double inverse_mass = 0;                                 ///< 1/kg; 0: nothing moves it but itself
  /// About its centre, in the world, 1/(kg m2); 0: nothing turns it but itself, as a ball, whose turning
  /// nobody sees.
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
  /// It was put where it is since the last step: what of a cloth is inside is let out without motion
  /// (settle); pushed out by the step it would fly off.
  bool just_put = false;
  /// It moves, moved since the start or may; else it is where the scene has it: the ground.
  bool mobile = false;
  Vec3 start{0, 0, 0};     ///< centre at the step's start, m
  Vec3 position{0, 0, 0};  ///< at its end, m
  Vec3 velocity{0, 0, 0};  ///< along the way, m/s
  Vec3 turn{0, 0, 0};      ///< in the step, about this axis by its length, rad
  Vec3 spin{0, 0, 0};      ///< rad/s

  /// But for the shape, which does not change (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, rotation, friction, inverse_mass, inverse_inertia, just_put, mobile, start, position,
            velocity, turn, spin);
  }
  /// Cloth may be drawn round it. By a wall it is struck all over, and stretched by nothing.
  bool has_an_end() const { return !std::holds_alternative<HalfSpace>(shape); }
  /// Takes up what the cloth gives it.
  bool yields() const { return inverse_mass > 0; }
  /// Takes up what the cloth gives it by turning, too.
  bool yields_turning() const { return !inverse_inertia.isZero(0); }
  /// The inverse of the mass, 1/kg, that a force finds at `arm`, m, from the centre, along the unit
  /// `direction` (Baraff, Physically Based Modeling: Rigid Body Simulation, 2001, Eq. 8-18, one body's part).
  double inverse_mass_at(const Vec3& arm, const Vec3& direction) const {
    const Vec3 lever = arm.cross(direction);
    return inverse_mass + lever.dot(inverse_inertia * lever);
  }
  /// From `fraction` of a step of `dt` seconds on it has this velocity and this spin; unless they are not
  /// finite, as they are in a step that is going to be taken back.
  void go_on(const Vec3& with, const Vec3& spinning, double fraction, double dt);
  /// As seen from `place`, m.
  Solid from(const Vec3& place) const {
    Solid seen = *this;
    seen.start -= place;
    seen.position -= place;
    return seen;
  }
  /// Whatever moved it has come to its end: it stays where it is, and no force moves it.
  void stand() {
    start = position;
    velocity = turn = spin = Vec3::Zero();
    inverse_mass = 0;
    inverse_inertia.setZero();
  }
  /// Centre at `fraction` (0..1) of the step.
  Vec3 at(double fraction) const { return start + fraction * (position - start); }
  PlacedShape placed(double fraction) const {
    return {shape, at(fraction), turns() && fraction != 1 ? turned(fraction - 1) * rotation : rotation};
  }
  /// How far outside a node is that is at `node` when a part of the step begins at `from`, m; below 0 inside.
  double gap(const Vec3& node, double from) const;
  bool turns() const { return !turn.isZero(0); }
  bool moves() const { return position != start || !velocity.isZero(0) || turns(); }
  RigidMove move(double from, double to) const {
    RigidMove made{at(to) - at(from), at(from), turns()};
    if (made.turns) made.turn = turned(to - from);
    return made;
  }
  /// How far a point goes that is at `point` at `from` and then goes with it, m.
  Vec3 move_of(const Vec3& point, double from, double to) const { return move(from, to).of(point); }

 private:
  /// What it turns by in that part of the step.
  Eigen::Matrix3d turned(double part) const;
};

}  // namespace weft
