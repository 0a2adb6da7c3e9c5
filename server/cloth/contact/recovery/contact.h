#pragma once
#include <cstdint>
#include <vector>

#include "cloth/bodies/body_touch.h"
#include "cloth/contact/search/points_between.h"
#include "cloth/core/substep.h"

namespace weft {

/// Counted since the cloth was made: shows that tiles far from all solids are never looked at.
struct ContactCounters {
  std::uint64_t tiles_examined = 0;  ///< tiles whose nodes were tested against a solid
  std::uint64_t nodes_tested = 0;
  std::uint64_t nodes_in_contact = 0;  ///< nodes, and points between, found inside a solid or on a way
                                       ///< through, and brought out, or kept there

  template <class Archive>
  void serialize(Archive& archive) {
    archive(tiles_examined, nodes_tested, nodes_in_contact);
  }

  friend ContactCounters operator+(const ContactCounters& a, const ContactCounters& b) {
    return {a.tiles_examined + b.tiles_examined, a.nodes_tested + b.nodes_tested,
            a.nodes_in_contact + b.nodes_in_contact};
  }
};

/// A node, or a point between nodes, on a solid.
struct Touch {
  std::size_t node = 0;  ///< index into the grid's arrays
  ColliderId collider = 0;
  std::uint8_t within = 0;  ///< PointId's

  template <class Archive>
  void serialize(Archive& archive) {
    archive(node, collider, within);
  }

  PointId point() const { return {node, within}; }
  friend bool operator==(const Touch&, const Touch&) = default;
  friend bool operator<(const Touch& a, const Touch& b) {
    return a.point() == b.point() ? a.collider < b.collider : a.point() < b.point();
  }
};

/// A node, or a point between nodes, on its way into a solid.
struct Arrival {
  Touch touch;
  std::size_t solid = 0;  ///< index
  Surface surface;        ///< the tangent plane where they meet, as it will be beside it if both go on
  double approach = 0;    ///< of one to the other, along the normal, m/s
};

/// The paper's section 2.4, second half: in the struck tiles a particle inside a ball, or another solid, is
/// pushed back to its surface and loses the part of its velocity, relative to the solid, that points into it.
/// Coulomb's friction, which the paper has not, slows what is left of it by up to friction times the speed
/// lost. A particle at a ball's very centre leaves upwards. Pinned nodes stay.
///
/// A solid that yields takes up, node by node, the momentum that they lose: each hit leaves the two with one
/// velocity along the normal, as bodies of their masses that hit plastically, so that it keeps their momentum
/// and never adds energy, whichever is the heavier.
///
/// A solid that would slip between the nodes meets points between them as well (points_between).
///
/// Where nodes and a solid approach by more than a part of its width in a substep, their ways are compared
/// instead of their last places (continuous collision): a node goes on from where it met the surface, with
/// the solid, and slides.
template <class Real>
class Contact {
 public:
  explicit Contact(const Grid& grid) : broad_phase_(grid) {}
  /// What is cut of the cloth, which keeps it; nullptr while it is whole. Holes catch nothing.
  void set_torn(const TornLinks* torn) {
    if (torn_ != torn) std::erase_if(touches_, [](const Touch& t) { return t.point().between_nodes(); });
    torn_ = torn;
  }

  /// Resolves the contacts at a substep's end, from which on solids that yield have the velocity that their
  /// momentum gives. `start` holds the nodes' places at its start, if the integrator has had friction bear on
  /// their ways: it then leads none back farther than it let them slip. Without it they
  /// came there with the velocities that they have. Returns the number of nodes in contact in this call.
  /// `rounded_off`, if the integrator keeps it, is what the positions' rounding leaves out, m.
  int resolve(Particles<Real>& particles, std::vector<Solid>& solids, const Substep& substep,
              const VectorField<Real>* start = nullptr, VectorField<Real>* rounded_off = nullptr);

  /// Before a substep: adds to touches() the free nodes that will be in a solid that does not yield at the
  /// substep's end if they go on with the velocity and the acceleration they have.
  const std::vector<Touch>& expect(const Particles<Real>& particles, const std::vector<Solid>& solids,
                                   const Substep& substep);
  /// The free nodes that are now in a solid, as it is at the substep's end. Valid until the next call.
  const std::vector<Touch>& inside(const Particles<Real>& particles, const std::vector<Solid>& solids,
                                   const Substep& substep);
  /// Before a substep: the free nodes that will pass the surface of a solid that is `sought`, as a rule of
  /// one that yields, if all go on as they go. Valid until the next call.
  const std::vector<Arrival>& foresee(
      const Particles<Real>& particles, const std::vector<Solid>& solids, const Substep& substep,
      bool (*sought)(const Solid&) = [](const Solid& solid) { return solid.yields(); }) {
    return foresee(particles, particles.velocity, solids, substep, sought);
  }
  /// The same, the nodes going with these velocities, m/s.
  const std::vector<Arrival>& foresee(const Particles<Real>& particles, const VectorField<Real>& velocity,
                                      const std::vector<Solid>& solids, const Substep& substep,
                                      bool (*sought)(const Solid&));

  /// The free nodes that have passed the surface of a solid, wherever they are now, on their ways from
  /// `start`, where they were as the substep began. Of slow ones none: those are inside(). Valid until the
  /// next call.
  const std::vector<Arrival>& passed(const Particles<Real>& particles, const VectorField<Real>& start,
                                     const std::vector<Solid>& solids, const Substep& substep);

  /// Before a step: the pinned nodes, and points between such, that a solid which yields may come to in it,
  /// going no farther than it does now, if no pin goes farther than `longest`, m; by point.
  std::vector<NearPoint> pinned_near(const Particles<Real>& particles, const std::vector<Solid>& solids,
                                     double longest);

  /// Before resolve: these lay on a solid when the substep began, and neither the ways they had nor a
  /// constraint holds them to it; ordered. Those that forces have drawn past it and away have slid off
  /// its side: resolve does not stop them.
  void let_slide_off(const std::vector<Touch>& not_held) { not_held_ = not_held; }
  /// Before resolve: constraints have kept these on their side of a solid; ordered. Their ways are not looked
  /// at again: where one cuts an edge they would be put back onto the face that they came from.
  void trust(const std::vector<Touch>& kept_aside) { kept_aside_ = kept_aside; }
  /// After resolve: these are in contact, too, be they outside by a hair, where what presses them put them.
  /// Returns how many resolve did not find.
  int keep(const std::vector<Touch>& pressed);

  /// Where the solids touch one another in the step that begins, which a method that solves for bodies on the
  /// cloth has them push each other at, and tells the impulse; nullptr: nowhere.
  void set_body_touches(std::vector<BodyTouch>* touches) { body_touches_ = touches; }
  std::vector<BodyTouch>* body_touches() const { return body_touches_; }

  /// What the last resolve found in contact, ordered by tile, then node, with what slid off, and then what
  /// was kept; after expect() by node, then collider.
  const std::vector<Touch>& touches() const { return touches_; }
  const ContactCounters& counters() const { return counters_; }
  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(counters_, touches_, not_held_, kept_aside_);
  }
  const BroadPhase<Real>& broad_phase() const { return broad_phase_; }

 private:
  /// Adds to `found` the free nodes that are, at these positions, in a solid that is `sought`, as that is at
  /// the substep's end.
  void find_inside(const Particles<Real>& particles, const VectorField<Real>& position,
                   const std::vector<Solid>& solids, const Substep& substep, bool (*sought)(const Solid&),
                   std::vector<Touch>& found);

  /// Fills arrivals_ with the free nodes that pass the surface of a solid that is `sought` on their ways from
  /// `position` to `ends`, the `longest` of them so long, m, as seen from the solid longer than this `share`
  /// of its inner radius. `way_of(value)` is one's way, where value(field) is what a field has there.
  template <class Ends, class Way, class Sought>
  void find_arrivals(const Particles<Real>& particles, const VectorField<Real>& position, const Ends& ends,
                     double longest, double share, Way way_of, const std::vector<Solid>& solids,
                     const Substep& substep, Sought sought);

  /// Those between nodes that are near the last pairs' solids (points_between).
  std::vector<NearPoint> points_near(const Particles<Real>& particles, const VectorField<Real>& position,
                                     const std::vector<TileSolidPair>& pairs,
                                     const std::vector<Solid>& solids, const Sweep& sweep,
                                     PointHold hold = PointHold::free) const {
    return points_between(particles, position, broad_phase_.tiles(), pairs, solids, sweep, torn_, hold);
  }

  BroadPhase<Real> broad_phase_;
  const TornLinks* torn_ = nullptr;
  ContactCounters counters_;
  std::vector<Touch> touches_, inside_, not_held_, kept_aside_;
  std::vector<Arrival> arrivals_;
  std::vector<BodyTouch>* body_touches_ = nullptr;
  VectorField<Real> ahead_;  ///< where the nodes will be if they go on
  VectorField<Real> began_;  ///< where they were as the substep began
};

extern template class Contact<float>;
extern template class Contact<double>;

}  // namespace weft
