#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "cloth/air/air.h"
#include "cloth/core/particles.h"
#include "cloth/shapes/solid.h"
#include "cloth/sleep/islands.h"

namespace weft {

/// Tells whether a cloth sleeps: one that has hardly moved for a while is left as it is, to the bit, until
/// something comes near. What counts is how far its nodes get, not how fast they are at any moment: rounding
/// shakes stiff cloth for ever, by micrometres but at millimetres a second.
///
/// Cloths that touch fall asleep together, and a cloth with the bodies on it: one that slept under another
/// that still moves would be woken by it at once, and the other thrown by what had been a rock to it for a
/// step.
///
/// A cloth that is told to rest sleeps though it moves, in any wind; its time stands still.
class Sleep {
 public:
  /// The cloths that it touches, and those that they touch.
  enum class Company : std::uint8_t { none, restless, quiet };

  /// Steps in a row after which all nodes must lie as near to where they were after the first as the
  /// threshold takes them in that time.
  static constexpr int kQuietSteps = weft::kQuietSteps;
  /// A solid is near that comes within this share of the cloth's largest extent of its bounding box.
  static constexpr double kMargin = 0.01;

  /// Sleeps when no node gets on at more than `speed`, m/s; 0: never.
  explicit Sleep(double speed) : threshold_(speed) {}

  bool asleep() const { return asleep_ || (left_out_ && resting_ && !roused_); }
  /// The next step is made, and those after it until the cloth is at rest again; of a cloth told to rest the
  /// next one only.
  void wake() {
    rise();
    roused_ = true;
  }
  /// It sleeps, or would but for its company.
  bool quiet() const { return asleep() || (!watched_.empty() && quiet_steps_ >= kQuietSteps); }
  void set_company(Company company) { company_ = company; }
  void set_resting(bool resting) { resting_ = resting; }
  bool resting() const { return resting_; }
  /// The last step was left out though the cloth may move, as it was told to rest.
  bool left_out() const { return left_out_; }
  /// Before a step: true if the cloth sleeps through it. It wakes when the wind changes, and when near it a
  /// solid moves, yields, came or went. In gusts and turbulence it never sleeps. A cloth told to rest sleeps
  /// but for the steps in which a solid near it moves or yields.
  template <class Real>
  bool through(const Particles<Real>& particles, const std::vector<Solid>& solids, const Air& air);
  /// It, for islands: it is quiet while it sleeps or would but for what lies on it.
  template <class Real>
  Sleeper sleeper(const Particles<Real>& particles) const;
  /// After a step of dt, s, that left the cloth at `speed` at most, m/s: falls asleep if it is time.
  template <class Real>
  void stepped(double speed, double dt, const Particles<Real>& particles, const std::vector<Solid>& solids);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(quiet_steps_, watched_, asleep_, resting_, left_out_, roused_, company_, wind_, box_,
            neighbours_);
  }

 private:
  /// A solid that lies near, as it lay when the cloth fell asleep.
  struct Neighbour {
    ColliderId id;
    Vec3 low, high;  ///< corners of its bounding box
    bool operator==(const Neighbour&) const = default;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(id, low, high);
    }
  };
  /// The solids near the box; nothing if one of them moves or might.
  std::optional<std::vector<Neighbour>> neighbours(const std::vector<Solid>& solids) const;

  /// Unless a solid near it moves.
  template <class Real>
  void fall_asleep(const Particles<Real>& particles, const std::vector<Solid>& solids);
  void rise() {
    asleep_ = false;
    watched_.clear();
  }
  /// The nodes' positions now begin a quiet time; what was watched is forgotten.
  template <class Real>
  void watch(const Particles<Real>& particles);
  /// All nodes are within `distance`, m, of where they were when the quiet time began.
  template <class Real>
  bool stayed(double distance, const Particles<Real>& particles) const;

  double threshold_;
  int quiet_steps_ = 0;
  /// Positions in the world when the quiet time began; empty while the cloth plainly moves.
  std::vector<Vec3> watched_;
  bool asleep_ = false;
  bool resting_ = false;  ///< it is told to
  bool left_out_ = false;
  bool roused_ = false;  ///< since the last step
  Company company_ = Company::none;
  Vec3 wind_{0, 0, 0};
  Eigen::AlignedBox3d box_;  ///< with the margin, as the cloth lay when it fell asleep or was left out
  std::vector<Neighbour> neighbours_;
};

}  // namespace weft
