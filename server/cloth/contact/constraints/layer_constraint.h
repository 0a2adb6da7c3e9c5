#pragma once
#include <limits>
#include <optional>
#include <span>

#include "cloth/contact/constraints/pair_forces.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/solver/system_couplings.h"

namespace weft {

/// A pair of layers in an implicit substep: a spring between its four nodes that holds them apart along the
/// normal and drags across it (LayerContacts). Forces and ways are functions of the nodes' moves, m.
template <class Real>
struct LayerConstraint {
  using Moves = std::span<const kernels::Components<const Real>>;  // one a part

  typename SystemCouplings<Real>::Coupling coupling;  ///< of the free nodes
  Vec3 normal;
  double distance = 0;  ///< along the normal as the substep begins, m
  double closing = 0;   ///< of which is gained, if all go on as before, m
  double wanted = 0;    ///< distance in the end, m
  double gap = 0;       ///< at which they touch, m
  double spare = 0;     ///< distance as the substep ends, if the free nodes stay, less what is wanted, m
  Vec3 slid;            ///< what the others slide, m
  double sliding = 0;   ///< along the surface, if all go on as before, m
  SlipGain gained;      ///< of the substeps before
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

  /// Calls visit(part, node index, weight) for each free node.
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (coupling.weight[i] != 0) visit(coupling.part[i], coupling.node[i], coupling.weight[i]);
    }
  }
  /// The part that all its free nodes belong to, if there is one; with no free node the first one.
  std::optional<std::size_t> only_part() const {
    std::optional<std::size_t> only;
    for (std::size_t i = 0; i < 4; ++i) {
      if (coupling.weight[i] == 0) continue;
      if (only && *only != coupling.part[i]) return std::nullopt;
      only = coupling.part[i];
    }
    return only ? only : 0;
  }
  /// Distance as the substep ends, less what is wanted, m.
  double room(Moves move) const {
    double sum = spare;
    for_each_node([&](std::size_t part, std::size_t node, double weight) {
      sum += weight * normal.dot(at(move[part], node));
    });
    return sum;
  }
  /// Across the normal, m.
  Vec3 slip(Moves move) const {
    Vec3 sum(0, 0, 0);
    for_each_node(
        [&](std::size_t part, std::size_t node, double weight) { sum += weight * at(move[part], node); });
    return slid + across(sum, normal);
  }
  /// Along the normal, N; below 0 it would pull.
  double push(Moves move) const { return pressed - stiffness * room(move); }
  /// Along the surface, N.
  Vec3 rub(Moves move) const { return grip - friction * slip(move); }
  /// Nodes of another cloth that can move are among them.
  bool between_cloths() const { return inertia < std::numeric_limits<double>::infinity(); }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(coupling.part, coupling.node, coupling.weight, normal, distance, closing, wanted, gap, spare,
            slid, sliding, gained, memory, pressed, lasting, holds, stiffness, friction, grip, acts, edges,
            inertia, key);
  }
};

}  // namespace weft
