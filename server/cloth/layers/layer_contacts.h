#pragma once
#include "cloth/contact/contact.h"
#include "cloth/layers/layer_nodes.h"
#include "cloth/solver/node_couplings.h"

namespace weft {

/// Two features of cloth that lie on each other or will in the step.
struct LayerPair {
  FeaturePair features;
  Nearness near;  ///< as the step begins
  Vec3 normal;    ///< from the second feature to the first
  double gap;     ///< to be kept between them, m
  int side = 0;   ///< of the first node's sheet on which the triangle lies, 0 or 1
};

/// How layers press on one another and rub.
struct LayerParameters {
  double thickness = 0;  ///< m
  double friction = 0;
};

/// The contacts of one cloth with itself and others as a part of its step. A pair that would come nearer than
/// its gap is held apart along its normal, without bouncing, and rubs by Coulomb's friction.
///
/// To an implicit step it is a spring between the four nodes, as contact_constraints.h has it for solids: it
/// begins to act where the nodes' velocities would bring them too near or where it acted in the last step,
/// is stiffened where layers are pressed far into their gap (as the net would else have to hold them), is
/// taken away if it pulls, and drags with at most friction times the force of the step before. So layers
/// that press on each other stand in equilibrium with all other forces, and nothing is put right at nobody's
/// cost. Layers nearer than their gap are led apart by a part of what they lack a step.
///
/// To an explicit substep it is an inelastic impulse.
///
/// Nodes of another cloth are seen going on with their velocity; approached, along the normal with the one
/// that a plastic hit would leave them, so that two cloths, each seeing the other so, keep their momentum.
template <class Real>
class LayerContacts {
 public:
  LayerContacts(const LayerNodes& nodes, std::size_t cloth, const LayerParameters& parameters);

  /// The pairs of the step that have nodes of this cloth; forces are remembered by node.
  void set_pairs(std::vector<LayerPair> pairs) { pairs_ = std::move(pairs); }
  /// Nothing for a step to do.
  bool empty() const { return pairs_.empty() && struck_.empty(); }

  // An implicit substep.

  /// At the substep's begin; moving pins are where they will be at its end.
  void begin(const Particles<Real>& particles, const Substep& substep);
  /// Adds the constraints to the system of a Newton iteration at `move`; `diagonal` is the system's, N/m.
  void add_to(kernels::Components<Real> b, NodeCouplings<Real>& couplings, const Real* diagonal,
              kernels::Components<const Real> move);
  /// Takes away what pulls at `move` and brings back what is too near. Returns the energy of their springs,
  /// J.
  double release_pulling(kernels::Components<const Real> move);
  /// Reads the forces off the solution; struck() is empty afterwards.
  void finish(kernels::Components<const Real> move);
  /// Calls visit(node index) for every node of a pair that acts, and for those in struck().
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (const std::size_t node : struck_) visit(node);
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

 private:
  struct Constraint {
    typename NodeCouplings<Real>::Coupling coupling;  ///< of the free nodes
    Vec3 normal;
    double room;     ///< along the normal as the substep ends, if the free nodes stay, less the gap, m
    Vec3 slid;       ///< what the others slide, m
    double sliding;  ///< along the surface, if all go on as before, m
    double holds;    ///< at most, by friction, N
    double stiffness = 0;
    bool acts = true;
    double kept = 0;  ///< gap that is wanted in the end, less what is wanted now, m
    double gap = 0;   ///< wanted in the end, m
    int memory = -1;  ///< index into force_
  };
  bool own(std::uint32_t node) const { return node >= first_ && node < end_; }
  /// Where force_ keeps what presses on the pair's node from that side; -1 for edges and others' nodes.
  int memory_of(const LayerPair& pair) const;
  double room(const Constraint& c, kernels::Components<const Real> move) const;
  void adapt(kernels::Components<const Real> move);
  Vec3 slip(const Constraint& c, kernels::Components<const Real> move) const;
  /// What others' nodes are faster by, along the pair's normal, for being pushed by this cloth's, m/s.
  double yielding(const LayerPair& pair, const FourPoints& own_velocity) const;

  const LayerNodes& nodes_;
  std::uint32_t first_, end_;  ///< of this cloth's nodes
  LayerParameters parameters_;
  std::vector<LayerPair> pairs_;
  std::vector<Constraint> constraints_;
  std::vector<float> force_;      ///< N, on each node from either side
  std::vector<float> stiffness_;  ///< at each node, as a multiple of the inertia
  std::vector<char> strained_;    ///< at each node in this step: 1 if a gap was half kept, 2 if hardly
  std::vector<std::size_t> struck_;
};

extern template class LayerContacts<float>;
extern template class LayerContacts<double>;

}  // namespace weft
