#pragma once
#include <vector>

#include "cloth/core/path.h"

namespace weft {

/// Steps in a row after which what has hardly moved lies still. A second at 60 Hz: what turns round, as a
/// pendulum does, is slow for a moment only.
inline constexpr int kQuietSteps = 60;

/// Bodies' boxes are larger by this share of their largest extent where it is looked for who is near.
inline constexpr double kRestMargin = 0.01;

/// Tells whether a ball or a body lies still, and keeps that it sleeps. What counts is how far it gets, not
/// how fast it is at any moment, as for cloths (Sleep).
class BodyRest {
 public:
  /// It has hardly moved for kQuietSteps steps; so it stays while it sleeps.
  bool quiet() const { return quiet_steps_ >= kQuietSteps; }
  bool asleep() const { return asleep_; }
  /// Left where it is, to the bit, from now on.
  void sleep() { asleep_ = true; }
  /// It is at rest no sooner than kQuietSteps steps from now.
  void wake() { *this = BodyRest(); }
  /// After a step that left it at `pose`; `reach`, m, is how far from its centre it has points at most.
  /// Quiet: none of them got farther than `distance`, m, from where it was when the quiet time began.
  void stepped(const Pose& pose, double reach, double distance);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(began_, quiet_steps_, asleep_);
  }

 private:
  Pose began_;  ///< where the quiet time began
  int quiet_steps_ = 0;
  bool asleep_ = false;
};

/// Something that moves, or may, where islands are looked for.
struct Sleeper {
  Eigen::AlignedBox3d box;  ///< that it is within all the step, and a margin
  bool quiet = false;
};

/// Bodies and cloths that lie on one another sleep and wake together: an island is what is joined by boxes
/// that overlap, and it is at rest if all of it is quiet (Catto, Box2D's islands; here without a memory, so
/// that it follows from the state alone). For each sleeper, whether its island is at rest. What has no proper
/// box, as one of NaN, is an island by itself.
std::vector<bool> islands_at_rest(const std::vector<Sleeper>& sleepers);

}  // namespace weft
