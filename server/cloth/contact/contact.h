#pragma once
#include <compare>
#include <cstdint>

#include "cloth/contact/broad_phase.h"

namespace weft {

/// Counted since the cloth was made: shows that tiles far from all solids are never looked at.
struct ContactCounters {
  std::uint64_t tiles_examined = 0;  ///< tiles whose nodes were tested against a solid
  std::uint64_t nodes_tested = 0;
  std::uint64_t nodes_in_contact = 0;  ///< nodes found inside a solid, or on a way through, and brought out

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

/// A node on a solid.
struct Touch {
  std::size_t node = 0;  ///< index into the grid's arrays
  ColliderId collider = 0;

  friend auto operator<=>(const Touch&, const Touch&) = default;
};

/// The paper's section 2.4, second half: in the struck tiles a particle inside a ball, or another solid, is
/// pushed back to its surface and loses the part of its velocity, relative to the solid, that points into it.
/// Coulomb's friction, which the paper has not, slows what is left of it by up to friction times the speed
/// lost. A particle at a ball's very centre leaves upwards. Pinned nodes stay. The momentum taken is due to
/// solids that yield (impulses()).
///
/// Where nodes and a solid approach by more than a part of its width in a substep, their ways are compared
/// instead of their last places (continuous collision): a node goes on from where it met the surface, with
/// the solid, and slides.
template <class Real>
class Contact {
 public:
  explicit Contact(const Grid& grid) : broad_phase_(grid) {}

  /// Forgets the impulses of the step before.
  void begin_step(const std::vector<Solid>& solids) { impulses_.assign(solids.size(), Vec3::Zero()); }
  /// Adds to touches() the nodes that will be in a solid at the substep's end if they go on with the velocity
  /// and the acceleration they have. For implicit steps, which want to know before.
  const std::vector<Touch>& expect(const Particles<Real>& particles, const std::vector<Solid>& solids,
                                   const Substep& substep);
  /// Resolves the contacts at a substep's end. `start` holds the nodes' places at its start; without it they
  /// came there with the velocities that they have. Returns the number of nodes in contact in this call.
  /// `rounded_off`, if the integrator keeps it, is what the positions' rounding leaves out, m.
  int resolve(Particles<Real>& particles, const std::vector<Solid>& solids, const Substep& substep,
              const VectorField<Real>* start = nullptr, VectorField<Real>* rounded_off = nullptr);

  /// What the cloth gave to each solid since the step began, N s; nothing to those that do not yield. They
  /// get it from Colliders::push: cloths that are advanced at the same time share them.
  const std::vector<Vec3>& impulses() const { return impulses_; }
  std::vector<Vec3>& impulses() { return impulses_; }

  /// What the last resolve found in contact, ordered by tile, then node; after expect() by node, then
  /// collider.
  const std::vector<Touch>& touches() const { return touches_; }
  const ContactCounters& counters() const { return counters_; }
  const BroadPhase<Real>& broad_phase() const { return broad_phase_; }

 private:
  BroadPhase<Real> broad_phase_;
  ContactCounters counters_;
  std::vector<Touch> touches_;
  VectorField<Real> ahead_;  ///< where the nodes will be if they go on
  std::vector<Vec3> impulses_;
};

extern template class Contact<float>;
extern template class Contact<double>;

}  // namespace weft
