#pragma once
#include <memory>

#include "cloth/contact/constraints/layer_constraint.h"
#include "cloth/contact/constraints/layer_impulses.h"
#include "cloth/contact/constraints/layer_stiffness.h"
#include "cloth/contact/constraints/meeting_layers.h"
#include "cloth/solver/one_sided_springs.h"

namespace weft {

/// The contacts of one cloth with itself and others as a part of its step. A pair that would come nearer than
/// its gap is held apart along its normal, without bouncing, and rubs by Coulomb's friction.
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
/// Each cloth is stepped by itself and sees another's nodes as free masses with their present velocity. Both
/// share the impulse of a hit by their masses and keep their momentum as far as each foresees the other.
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
  /// `found` is the search that the steps' pairs come from. It and the nodes are kept by reference.
  LayerContacts(const LayerNodes& nodes, const FeatureSearch& found, const Grid& grid, std::size_t cloth,
                const LayerParameters& parameters);

  /// The pairs of the step that have nodes of this cloth; forces are remembered by node.
  void set_pairs(std::vector<LayerPair> pairs) {
    pairs_ = std::move(pairs);
    if (pairs_.empty()) given_.assign(given_.size(), Vec3(0, 0, 0));
  }
  /// What is cut of this cloth.
  void set_torn(const std::shared_ptr<const TornLinks>& torn) {
    meeting_.set_torn(torn);
    impulses_.set_torn(*torn);
  }
  /// Nothing for a step to do.
  bool empty() const { return pairs_.empty() && struck_.empty() && held_.empty(); }
  /// Other cloth may do work on this one in the step. Its own layers only take energy.
  bool meets_others() const;

  // An implicit substep.

  /// At the substep's begin; moving pins are where they will be at its end. The cloth may be near rest.
  void begin(const Particles<Real>& particles, const Substep& substep, bool near_rest);
  /// Adds the constraints to the system of a Newton iteration at `move`; `diagonal` is the system's, N/m.
  void add_to(kernels::Components<Real> b, NodeCouplings<Real>& couplings, const Real* diagonal,
              kernels::Components<const Real> move);
  /// Appends the constraints as they are at `move` along `change`.
  void append_springs(kernels::Components<const Real> move, kernels::Components<const Real> change,
                      std::vector<OneSidedSpring>& springs) const;
  /// Takes away what pulls at `move` and brings back what is too near. Returns the energy of their springs,
  /// J.
  double release_pulling(kernels::Components<const Real> move);
  /// Between Newton iterations: holds what would pass through each other on the way to these positions. False
  /// if there is nothing.
  bool hold_meeting(kernels::Components<const Real> position, kernels::Components<const Real> move);
  /// Reads the forces off the solution; struck() is empty afterwards.
  void finish(kernels::Components<const Real> move);
  /// Calls visit(node index) for every node of a pair that acts or did in the last step, and for those in
  /// struck(): of all their motion is not what it was.
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (const std::size_t node : struck_) visit(node);
    for (const std::size_t node : held_) visit(node);
    for (const LayerConstraint<Real>& c : constraints_) {
      if (c.acts) c.for_each_node([&](std::size_t node, double) { visit(node); });
    }
  }

  // An explicit substep.

  /// At the substep's end: pairs too near lose the speed at which they approach and rub, and are led apart.
  void resolve(Particles<Real>& particles, const Substep& substep);

  /// Nodes that were moved after the last step, by no force: their motion says nothing about what follows.
  std::vector<std::size_t>& struck() { return struck_; }
  /// What other cloths gave each node in the last step, N s.
  const std::vector<Vec3>& given() const { return given_; }
  /// Of all pairs that pressed in the last implicit substep; what they are changed to is carried on.
  std::vector<PairForce>& forces() { return forces_; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pairs_, constraints_, forces_, stiffness_, struck_, held_, given_, substep_, near_rest_, meeting_,
            impulses_);
  }

 private:
  bool own(std::uint32_t node) const { return node >= first_ && node < end_; }
  PairForce remembered(const PairKey& key) const;
  LayerConstraint<Real> constraint(const LayerPair& pair) const;
  /// The stiffness follows what the step's end shows.
  void adapt(kernels::Components<const Real> move);

  const LayerNodes* nodes_;
  const FeatureSearch* found_;
  std::uint32_t first_, end_;  ///< of this cloth's nodes
  LayerParameters parameters_;
  std::vector<LayerPair> pairs_;
  std::vector<LayerConstraint<Real>> constraints_;
  std::vector<PairForce> forces_;  ///< of the last substep, sorted
  LayerStiffness stiffness_;
  std::vector<std::size_t> struck_;
  std::vector<std::size_t> held_;  ///< nodes of the pairs that acted in the last implicit substep
  std::vector<Vec3> given_;
  Substep substep_;  ///< an implicit one
  bool near_rest_ = false;
  MeetingLayers meeting_;
  LayerImpulses<Real> impulses_;
};

extern template class LayerContacts<float>;
extern template class LayerContacts<double>;

}  // namespace weft
