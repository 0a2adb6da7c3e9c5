#pragma once
#include <optional>
#include <vector>

#include "cloth/contact/solid.h"
#include "cloth/description.h"
#include "cloth/particles.h"

namespace weft {

/// Tells whether a cloth sleeps: one that has hardly moved for a while is left as it is, to the bit, until
/// something comes near.
class Sleep {
 public:
  /// Steps in a row that all nodes must be slower than the threshold. A second at 60 Hz: what turns round, as
  /// a pendulum does, is slow for a moment only.
  static constexpr int kQuietSteps = 60;
  /// A solid is near that comes within this share of the cloth's largest extent of its bounding box.
  static constexpr double kMargin = 0.01;

  /// Sleeps when slower than `speed`, m/s; 0: never.
  explicit Sleep(double speed) : threshold_(speed) {}

  bool asleep() const { return asleep_; }
  void wake() {
    asleep_ = false;
    quiet_steps_ = 0;
  }
  /// Before a step: true if the cloth sleeps through it. It wakes when the wind changes, and when near it a
  /// solid moves, yields, came or went.
  bool through(const std::vector<Solid>& solids, const Wind& wind);
  /// After a step that left the cloth at `speed` at most, m/s: falls asleep if it is time.
  template <class Real>
  void stepped(double speed, const Particles<Real>& particles, const std::vector<Solid>& solids);

 private:
  /// A solid that lies near, as it lay when the cloth fell asleep.
  struct Neighbour {
    ColliderId id;
    Vec3 low, high;  ///< corners of its bounding box
    bool operator==(const Neighbour&) const = default;
  };
  /// The solids near the box; nothing if one of them moves or might.
  std::optional<std::vector<Neighbour>> neighbours(const std::vector<Solid>& solids) const;

  double threshold_;
  int quiet_steps_ = 0;
  bool asleep_ = false;
  Vec3 wind_{0, 0, 0};
  Eigen::AlignedBox3d box_;  ///< with the margin
  std::vector<Neighbour> neighbours_;
};

}  // namespace weft
