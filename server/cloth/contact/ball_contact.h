#pragma once
#include <cstdint>

#include "cloth/contact/broad_phase.h"

namespace weft {

/// Counted since the cloth was made: shows that tiles far from the balls are never looked at.
struct ContactCounters {
  std::uint64_t tiles_examined = 0;  ///< tiles whose nodes were tested against a ball
  std::uint64_t nodes_tested = 0;
  std::uint64_t nodes_in_contact = 0;  ///< nodes found inside a ball and brought out

  friend ContactCounters operator+(const ContactCounters& a, const ContactCounters& b) {
    return {a.tiles_examined + b.tiles_examined, a.nodes_tested + b.nodes_tested,
            a.nodes_in_contact + b.nodes_in_contact};
  }
};

/// A part of a step: it begins and ends at these fractions of the step and takes so many seconds.
struct Substep {
  double from = 0, to = 1;
  double seconds = 1.0 / 60;

  static Substep of(int index, int count, double dt) {
    return {static_cast<double>(index) / count, static_cast<double>(index + 1) / count, dt / count};
  }
};

/// A node on a ball.
struct Touch {
  std::size_t node = 0;  ///< index into the grid's arrays
  BallId ball = 0;
};

/// The paper's section 2.4, second half: in the struck tiles a particle inside a ball is pushed back to its
/// surface and loses the part of its velocity, relative to the ball, that points into it. Coulomb's friction,
/// which the paper has not, slows what is left of it by up to friction times the speed lost. A particle at
/// the very centre leaves upwards. Pinned nodes stay. The momentum taken is due to dynamic balls
/// (impulses()).
template <class Real>
class BallContact {
 public:
  explicit BallContact(const Grid& grid) : broad_phase_(grid) {}

  /// Forgets the impulses of the step before.
  void begin_step(const std::vector<Ball>& balls) { impulses_.assign(balls.size(), Vec3::Zero()); }
  /// Resolves the contacts at a substep's end. Returns the number of nodes in contact in this call.
  int resolve(Particles<Real>& particles, const std::vector<Ball>& balls, const Substep& substep);

  /// What the cloth gave to each ball since the step began, N s; nothing to kinematic ones. The balls get it
  /// from Colliders::push: cloths that are advanced at the same time share them.
  const std::vector<Vec3>& impulses() const { return impulses_; }
  std::vector<Vec3>& impulses() { return impulses_; }

  /// What the last resolve found in contact, ordered by tile, then node.
  const std::vector<Touch>& touches() const { return touches_; }
  const ContactCounters& counters() const { return counters_; }
  const BroadPhase<Real>& broad_phase() const { return broad_phase_; }

 private:
  BroadPhase<Real> broad_phase_;
  ContactCounters counters_;
  std::vector<Touch> touches_;
  std::vector<Vec3> impulses_;
};

extern template class BallContact<float>;
extern template class BallContact<double>;

}  // namespace weft
