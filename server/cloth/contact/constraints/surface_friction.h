#pragma once
#include "cloth/contact/constraints/slip_gain.h"
#include "cloth/core/vec3.h"

namespace weft {

/// Coulomb friction of one contact in an implicit step: a spring along the surface that gives as soon as it
/// would pull by more than the friction coefficient times the normal force (return mapping, as in plasticity:
/// Wriggers, Computational Contact Mechanics, 2006, section 5.2). What it pulls by lasts from step to step,
/// so that what sticks does not creep.
///
/// To a linear system a spring that gives is a weaker one, whose force is right at the slip that is expected:
/// it never drives the motion, however far the expectation was off. The next linearisation expects the slip
/// that was found. Only what sticks and is pulled too hard would find its slip too slowly by that, as it is
/// held by the full spring: it is expected to slide as the node alone would.
class SurfaceFriction {
 public:
  SurfaceFriction() = default;
  /// Of what would slip by `slip`, m, in the substep if it went on as it goes. Of that friction stops
  /// `stopped`, m, where it meets the surface: by Coulomb's law the coefficient times how deep it would go
  /// in.
  SurfaceFriction(const Vec3& slip, double stopped) : going_on_(slip), stopped_(stopped) {}
  /// The contact was there in the last step, when its friction ended up as `last`.
  void go_on_from(const SurfaceFriction& last);
  /// And what it holds by then it holds by now, along the surface with this normal.
  void keep_force_of(const SurfaceFriction& last, const Vec3& normal);

  /// For the next linear system, where it has slipped by `slip`, m, in the substep: friction holds at most
  /// `holds`, N, by a spring of `stiffness`, N/m. `inertia` is the node's resistance to a move, N/m.
  void linearise(const Vec3& slip, double holds, double stiffness, double inertia);
  /// In the linear system, N/m.
  double rate() const { return rate_; }
  /// By the linear system, at a slip, N.
  Vec3 force(const Vec3& slip) const { return rate_ > 0 ? Vec3(rate_ * stretch(slip)) : Vec3(0, 0, 0); }
  /// The energy by which the linear system misjudges a slip at which friction holds at most `holds`, J.
  double error(const Vec3& slip, double holds) const;
  /// The substep ends so.
  void end(const Vec3& slip, double holds);
  /// After end: the force, N.
  const Vec3& grip() const { return grip_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(grip_, going_on_, stopped_, gained_, stiffness_, rate_, inertia_, lasts_, solved_);
  }

 private:
  /// Of the spring, m.
  Vec3 stretch(const Vec3& slip) const { return grip_ / stiffness_ - slip; }
  double expected_stretch() const;
  void hold_at(double stretch, double holds);

  Vec3 grip_{0, 0, 0};      ///< when the substep begins, N
  Vec3 going_on_{0, 0, 0};  ///< slip in the substep if it goes on as before, m
  double stopped_ = 0;      ///< of that, as it meets the surface, m
  SlipGain gained_;
  double stiffness_ = 0, rate_ = 0;  ///< of the spring that sticks, and as it is taken, N/m
  double inertia_ = 0;               ///< of the node, N/m
  bool lasts_ = false;               ///< it was there in the last step
  bool solved_ = false;              ///< in this substep, once
};

}  // namespace weft
