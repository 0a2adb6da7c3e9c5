#pragma once
#include <array>
#include <cstdint>

#include "cloth/core/particles.h"
#include "cloth/kernels/node_vector.h"

namespace weft {

/// Points that lie in a cell are told by their row and column among so many a side.
inline constexpr int kCellParts = 8;

/// Names a node, or a point of the cell that begins at it.
struct PointId {
  std::size_t node = 0;  ///< index into the grid's arrays
  /// Row * kCellParts + column within the cell, counted along v and along u; 0: the node itself.
  std::uint8_t within = 0;

  bool between_nodes() const { return within != 0; }
  /// Where it is in the cell along u and along v, 0 to 1.
  double u() const { return double(within % kCellParts) / kCellParts; }
  double v() const {
    const int row = within / kCellParts;
    return double(row) / kCellParts;
  }
  friend bool operator==(const PointId&, const PointId&) = default;
  friend bool operator<(const PointId& a, const PointId& b) {
    return a.node != b.node ? a.node < b.node : a.within < b.within;
  }
};

/// A node, or a point between two or four: its place is bilinear in theirs, and what happens to it happens to
/// them by their shares. A force at it acts on each node by its weight; an impulse moves each by its weight
/// and its inverse mass, so that the point finds the mass 1 / sum(weight^2 / mass).
template <class Real>
class ClothPoint {
 public:
  ClothPoint() = default;
  ClothPoint(const PointId& id, const Particles<Real>& particles);

  /// Of a field of places or velocities that pinned nodes have as well.
  Vec3 of(const kernels::Components<const Real>& field) const {
    return count_ == 1 ? at(field, node_[0]) : sum(field, weight_);
  }
  /// Of a field of moves that pinned nodes have not.
  Vec3 moved_by(const kernels::Components<const Real>& field) const {
    return count_ == 1 ? at(field, node_[0]) : sum(field, moves_);
  }
  /// Adds to the nodes' forces what a force at the point is to them.
  void add_force(const kernels::Components<Real>& field, const Vec3& force) const {
    for (std::size_t k = 0; k < count_; ++k) {
      if (moves_[k] > 0) add(field, node_[k], moves_[k] * force);
    }
  }
  /// Changes a field of the free nodes so that the point's value changes by so much, as an impulse does.
  void shift(const kernels::Components<Real>& field, const Vec3& change) const {
    for_each_gain([&](std::size_t node, double gain) { add(field, node, gain * change); });
  }
  /// That an impulse finds, kg; of a pinned node its own, of a point whose nodes are all pinned 0.
  double mass() const { return mass_; }
  /// That a force finds where each node resists by its own in `diagonal`, N/m.
  double resistance(const Real* diagonal) const {
    if (count_ == 1) return double(diagonal[node_[0]]);
    double mobility = 0;
    for (std::size_t k = 0; k < count_; ++k) mobility += moves_[k] * moves_[k] / double(diagonal[node_[k]]);
    return 1 / mobility;
  }
  /// The part of it that hangs on free nodes, 0 to 1.
  double free_part() const { return moves_[0] + moves_[1] + moves_[2] + moves_[3]; }

  /// Calls visit(node index, weight) for each of its nodes.
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (std::size_t k = 0; k < count_; ++k) visit(node_[k], weight_[k]);
  }
  /// Calls visit(node index, what the node moves by when an impulse moves the point by 1) for its free nodes,
  /// and for a pinned node that is the point itself.
  template <class Visit>
  void for_each_gain(Visit visit) const {
    for (std::size_t k = 0; k < count_; ++k) {
      if (gain_[k] > 0) visit(node_[k], gain_[k]);
    }
  }
  const std::array<std::size_t, 4>& nodes() const { return node_; }
  /// The weights of free nodes; 0 for all else.
  const std::array<double, 4>& moves() const { return moves_; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(count_, node_, weight_, moves_, gain_, mass_);
  }

 private:
  void add_node(std::size_t node, double weight) {
    node_[count_] = node;
    weight_[count_++] = weight;
  }
  Vec3 sum(const kernels::Components<const Real>& field, const std::array<double, 4>& weight) const {
    Vec3 total(0, 0, 0);
    for (std::size_t k = 0; k < count_; ++k) total += weight[k] * at(field, node_[k]);
    return total;
  }

  std::size_t count_ = 1;
  std::array<std::size_t, 4> node_{};
  std::array<double, 4> weight_{1, 0, 0, 0}, moves_{}, gain_{1, 0, 0, 0};
  double mass_ = 0;  ///< kg
};

extern template class ClothPoint<float>;
extern template class ClothPoint<double>;

}  // namespace weft
