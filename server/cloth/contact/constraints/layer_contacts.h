#pragma once
#include <memory>

#include "cloth/contact/constraints/layer_constraint.h"
#include "cloth/contact/constraints/layer_impulses.h"
#include "cloth/contact/constraints/layer_stiffness.h"
#include "cloth/contact/constraints/meeting_layers.h"
#include "cloth/solver/one_sided_springs.h"

namespace weft {

/// One part's linear system in a Newton iteration, and the nodes' moves at which it is.
template <class Real>
struct LayerSystem {
  kernels::Components<Real> b;
  NodeCouplings<Real>* couplings;
  const Real* diagonal;  ///< the system's, N/m
  kernels::Components<const Real> move;
};

/// The contacts of cloths that are stepped together, with themselves, one another and others, as a part of
/// their step; each cloth is a part (LayerParts). A pair that would come nearer than its gap is held apart
/// along its normal, without bouncing, and rubs by Coulomb's friction.
///
/// To an implicit step it is a spring between the four nodes, as contact_constraints.h has it for solids: it
/// begins to act where the nodes' velocities would bring them too near or where it acted in the last step,
/// is stiffened where layers are pressed far into their gap (LayerStiffness), is taken away if it pulls, and
/// drags with at most friction times the force of the step before. That force also pushes on, so that the
/// spring has only to give the change (an augmented Lagrangian: Nocedal and Wright, Numerical Optimization,
/// 2006, 17.3): however strongly a rope is wrung, its layers come to equilibrium with all other forces, and
/// no correction after the step adds energy. Features that would still pass through each other at the end of
/// the step's iterations (MeetingLayers) are held, too, and further iterations follow. Layers nearer than
/// their gap are separated by a share of what they lack in each step, near rest until they have half of it.
///
/// To an explicit substep it is an inelastic impulse, and a drag on what separates slowly (LayerImpulses).
///
/// Implicit steps find all parts together: what one gives the other takes. A cloth that is stepped apart, by
/// another method or after its step was taken back, sees another's nodes as free masses with their present
/// velocity. Both share the impulse of a hit by their masses and keep their momentum as far as each foresees
/// the other.
///  - They are supported as in the steps before (LayerNodes::support). Otherwise they would bear half of a
///    sheet's weight in one step and more in the next.
///  - To an implicit step these masses are in series with the constraint's spring, and the force that is
///    carried on is the mean of what both have found (share_forces): each feels the other's weight.
///  - Of the force of a hit no more is carried on than the step before carried plus the nodes' own weight,
///    and nothing of what was found against a sleeping cloth: the soft spring would return it only where both
///    fly apart.
///  - Near rest a sticking contact keeps the friction that held it; computed anew in each step it would
///    creep.
///  - In a contact's first steps, which have no such force, the masses also keep their acceleration without
///    contact. Later that is mostly the noise of stiff springs and is left out.
template <class Real>
class LayerContacts {
 public:
  using Moves = typename LayerConstraint<Real>::Moves;  // one a part

  /// `found` is the search that the steps' pairs come from. It and the nodes are kept by reference.
  LayerContacts(const LayerNodes& nodes, const FeatureSearch& found, const LayerParts& parts,
                const LayerParameters& parameters);

  const LayerParts& parts() const { return parts_; }
  /// Goes on with what `before` remembers of the parts that both have.
  void take_over(const LayerContacts& before);
  /// The pairs of the step that have nodes of these cloths; forces are remembered by node.
  void set_pairs(std::vector<LayerPair> pairs) {
    pairs_ = std::move(pairs);
    if (pairs_.empty()) given_.assign(given_.size(), Vec3(0, 0, 0));
  }
  /// What is cut of a part.
  void set_torn(std::size_t part, const std::shared_ptr<const TornLinks>& torn);
  /// Nothing for a step to do.
  bool empty() const { return pairs_.empty() && struck_.empty() && held_.empty(); }
  /// Other cloth may do work on one of these in the step. Its own layers only take energy.
  bool meets_others() const;
  /// So may cloth that is stepped apart from these.
  bool meets_outsiders() const;

  // An implicit substep.

  /// At the substep's begin, with all parts. They may be near rest.
  void begin(std::span<const Particles<Real>* const> starts, const Substep& substep, bool near_rest);
  /// Adds the constraints to the parts' systems of a Newton iteration, and what couples them to `between`.
  void add_to(std::span<const LayerSystem<Real>> systems, SystemCouplings<Real>& between);
  /// Appends the constraints as they are at `move` along `change`.
  void append_springs(Moves move, Moves change, std::vector<OneSidedSpring>& springs) const;
  /// Takes away what pulls at `move` and brings back what is too near. Returns the energy of their springs,
  /// J.
  double release_pulling(Moves move);
  /// Between Newton iterations: holds what would pass through each other on the way to these positions. False
  /// if there is nothing.
  bool hold_meeting(Moves position, Moves move);
  /// Reads the forces off the solution; nothing is struck afterwards.
  void finish(Moves move);
  /// Calls visit(node index) for every node of a part that is in a pair which acts or did in the last step,
  /// or is struck: of all their motion is not what it was.
  template <class Visit>
  void for_each_node(std::size_t part, Visit visit) const {
    const std::uint32_t first = parts_[part].offset;
    const auto count = static_cast<std::uint32_t>(parts_[part].grid.size());
    for (const std::vector<std::uint32_t>* nodes : {&struck_, &held_}) {
      for (const std::uint32_t node : *nodes) {
        if (node >= first && node - first < count) visit(std::size_t{node - first});
      }
    }
    for (const LayerConstraint<Real>& c : constraints_) {
      if (!c.acts) continue;
      c.for_each_node([&](std::size_t of, std::size_t node, double) {
        if (of == part) visit(node);
      });
    }
  }

  // An explicit substep, of one part.

  /// At the substep's end: pairs too near lose the speed at which they approach and rub, and are led apart.
  void resolve(Particles<Real>& particles, const Substep& substep);

  /// A node was moved after the last step, by no force: its motion says nothing about what follows.
  void strike(std::size_t part, std::size_t node) {
    struck_.push_back(parts_[part].offset + static_cast<std::uint32_t>(node));
  }
  /// What cloths that are stepped apart gave a node in the last step, N s.
  const Vec3& given(std::size_t part, std::size_t node) const { return given_[parts_[part].offset + node]; }
  /// Of all pairs that pressed in the last implicit substep; what they are changed to is carried on.
  std::vector<PairForce>& forces() { return forces_; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pairs_, constraints_, forces_, stiffness_, struck_, held_, given_, substep_, near_rest_, meeting_,
            impulses_);
  }

 private:
  PairForce remembered(const PairKey& key) const;
  LayerConstraint<Real> constraint(const LayerPair& pair) const;
  /// Its nodes as LayerParts numbers them.
  std::array<std::size_t, 4> joined(const LayerConstraint<Real>& constraint) const;
  /// The stiffness follows what the step's end shows.
  void adapt(Moves move);
  void sort_forces();

  const LayerNodes* nodes_;
  const FeatureSearch* found_;
  LayerParts parts_;
  LayerParameters parameters_;
  std::vector<LayerPair> pairs_;
  std::vector<LayerConstraint<Real>> constraints_;
  std::vector<PairForce> forces_;  ///< of the last substep, sorted
  // By nodes as LayerParts numbers them:
  LayerStiffness stiffness_;
  std::vector<std::uint32_t> struck_;
  std::vector<std::uint32_t> held_;  ///< of the pairs that acted in the last implicit substep
  std::vector<Vec3> given_;
  Substep substep_;  ///< an implicit one
  bool near_rest_ = false;
  MeetingLayers meeting_;
  LayerImpulses<Real> impulses_;  ///< of the first part
};

extern template class LayerContacts<float>;
extern template class LayerContacts<double>;

}  // namespace weft
