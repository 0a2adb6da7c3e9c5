#pragma once
#include <algorithm>
#include <limits>
#include <memory>

#include "cloth/contact/constraints/pair_forces.h"
#include "cloth/contact/recovery/contact.h"
#include "cloth/contact/recovery/substep_net.h"
#include "cloth/solver/node_couplings.h"
#include "cloth/solver/one_sided_springs.h"

namespace weft {

/// Part of what layers lack of their gap that they are led apart in a step.
inline constexpr double kLayersLedApart = 0.1;

/// Two features of cloth that lie on each other or will in the step.
struct LayerPair {
  FeaturePair features;
  Nearness near;  ///< where they meet, or else as the step is expected to end
  Vec3 normal;    ///< from the second feature to the first
  double gap;     ///< to be kept between them, m
  int side = 0;   ///< of the first node's sheet on which the triangle lies, 0 or 1
  template <class Archive>
  void serialize(Archive& archive) {
    archive(features, near, normal, gap, side);
  }
};

/// How layers press on one another and rub.
struct LayerParameters {
  double gap = 0;      ///< between layers of the cloth, m
  double net_gap = 0;  ///< that the net keeps, m
  double friction = 0;
};

/// The contacts of one cloth with itself and others as a part of its step. A pair that would come nearer than
/// its gap is held apart along its normal, without bouncing, and rubs by Coulomb's friction.
///
/// To an implicit step it is a spring between the four nodes, as contact_constraints.h has it for solids: it
/// begins to act where the nodes' velocities would bring them too near or where it acted in the last step,
/// is stiffened where layers are pressed far into their gap, is taken away if it pulls, and drags with at
/// most friction times the force of the step before. That force also pushes on, so that the spring has only
/// to give the change (an augmented Lagrangian: Nocedal and Wright, Numerical Optimization, 2006, 17.3):
/// however strongly a rope is wrung, its layers come to equilibrium with all other forces, and no correction
/// after the step adds energy. Features that would still pass through each other at the end of the step's
/// iterations are held, too, and further iterations follow. Layers nearer than their gap are separated by a
/// share of what they lack in each step, near rest until they have half of it.
///
/// To an explicit substep it is an inelastic impulse, and a drag on what separates slowly; and what it misses
/// within the cloth SubstepNet holds.
///
/// Each cloth is stepped by itself and sees another's nodes as free masses with their present velocity. Both
/// share the impulse of a hit by their masses and keep their momentum as far as each foresees the other.
///  - From explicit substep to substep the other's nodes keep the velocity that the impulse gives them.
///    Otherwise two sheets on each other would swap velocities for ever.
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
    torn_ = torn;
    search_.set_torn(0, *torn);
    substep_net_.set_torn(*torn);
  }
  /// Nothing for a step to do.
  bool empty() const { return pairs_.empty() && struck_.empty() && held_.empty(); }

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
    for (const Constraint& c : constraints_) {
      if (!c.acts) continue;
      for (std::size_t i = 0; i < 4; ++i) {
        if (c.coupling.weight[i] != 0) visit(c.coupling.node[i]);
      }
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
    archive(pairs_, constraints_, forces_, stiffness_, strained_, struck_, held_, given_, others_, substep_,
            place_, near_rest_, own_, search_, substep_net_, rounds_);
  }

 private:
  struct Constraint {
    typename NodeCouplings<Real>::Coupling coupling;  ///< of the free nodes
    Vec3 normal;
    double distance = 0;  ///< along the normal as the substep begins, m
    double closing = 0;   ///< of which is gained, if all go on as before, m
    double wanted = 0;    ///< distance in the end, m
    double gap = 0;       ///< at which they touch, m
    double room = 0;      ///< as the substep ends, if the free nodes stay, less what is wanted, m
    Vec3 slid;            ///< what the others slide, m
    double sliding = 0;   ///< along the surface, if all go on as before, m
    double memory = 0;    ///< force of the substep before, N
    double pressed = 0;   ///< that is carried on, N
    double lasting = std::numeric_limits<double>::infinity();  ///< most that the next one is to carry on, N
    double holds = 0;                                          ///< at most, by friction, N
    double stiffness = 0, friction = 0;                        ///< N/m
    Vec3 grip{0, 0, 0};  ///< of static friction when the substep begins, N
    bool acts = true;
    bool edges = false;  ///< not a node and a triangle
    double inertia = 0;  ///< of others' nodes, N/m; infinite if they are fixed or none
    PairKey key{};
    template <class Archive>
    void serialize(Archive& archive) {
      archive(coupling.node, coupling.weight, normal, distance, closing, wanted, gap, room, slid, sliding,
              memory, pressed, lasting, holds, stiffness, friction, grip, acts, edges, inertia, key);
    }
  };
  /// A node of another cloth, as an explicit step foresees it: nothing but this cloth's layers and what
  /// withstood them before acts on it, and where it lies on a solid neither.
  struct Other {
    std::uint32_t node;
    Vec3 position, velocity;
    double inverse_mass;  ///< 1/kg
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, position, velocity, inverse_mass);
    }
  };
  /// At a substep's end, but for what the layers do in it.
  void move_others(const Substep& substep);
  Other& other(std::uint32_t node) {
    return *std::lower_bound(others_.begin(), others_.end(), node,
                             [](const Other& each, std::uint32_t n) { return each.node < n; });
  }
  bool own(std::uint32_t node) const { return node >= first_ && node < end_; }
  /// Not LayerNodes': to others the cloth stood still as the step began, though it may have woken in it.
  void read_masses(const Particles<Real>& particles);
  PairForce remembered(const PairKey& key) const;
  Constraint constraint(const LayerPair& pair) const;
  /// A pair of own_ as it meets on its way; none if it does not.
  std::optional<LayerPair> meeting(const FeaturePair& features) const;

  double room(const Constraint& c, kernels::Components<const Real> move) const;
  /// Along the normal, N; below 0 it would pull.
  double push(const Constraint& c, kernels::Components<const Real> move) const {
    return c.pressed - c.stiffness * room(c, move);
  }
  /// Along the surface, N.
  Vec3 rub(const Constraint& c, kernels::Components<const Real> move) const {
    return c.grip - c.friction * slip(c, move);
  }
  void adapt(kernels::Components<const Real> move);
  Vec3 slip(const Constraint& c, kernels::Components<const Real> move) const;

  const LayerNodes* nodes_;
  const FeatureSearch* found_;
  Grid grid_;
  std::shared_ptr<const TornLinks> torn_;  ///< nullptr while the cloth is whole
  std::uint32_t first_, end_;              ///< of this cloth's nodes
  LayerParameters parameters_;
  std::vector<LayerPair> pairs_;
  std::vector<Constraint> constraints_;
  std::vector<PairForce> forces_;  ///< of the last substep, sorted
  std::vector<float> stiffness_;   ///< at each node, as a multiple of the inertia
  std::vector<std::uint8_t> met_;  ///< by each node, in a round
  std::vector<char> strained_;     ///< at each node in this step: 1 if a gap was half kept, 2 if hardly
  std::vector<std::size_t> struck_;
  std::vector<std::size_t> held_;  ///< nodes of the pairs that acted in the last implicit substep
  std::vector<Vec3> given_;
  std::vector<Other> others_;  ///< of the step's pairs, by node
  Substep substep_;
  Vec3 place_{0, 0, 0};  ///< of this cloth in the substep (Particles::place)
  bool near_rest_ = false;
  LayerNodes own_;        ///< this cloth's nodes alone, on their ways in the substep
  FeatureSearch search_;  ///< among them
  SubstepNet substep_net_;
  int rounds_ = 0;  ///< in which meeting pairs were held, of the substep
};

extern template class LayerContacts<float>;
extern template class LayerContacts<double>;

}  // namespace weft
