#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace weft {

/// How stiff the constraints between a cloth's layers are at each of its nodes, as a multiple of the inertia
/// of the nodes that meet (LayerContacts). From step to step it grows where a constraint keeps too little of
/// its gap, and falls where all keep most of it: as soft as its load allows, since a linear solve takes the
/// more iterations the stiffer its constraints are.
class LayerStiffness {
 public:
  /// Of so many nodes, each as soft as can be.
  explicit LayerStiffness(std::size_t nodes);

  /// Of a constraint between these nodes, those without weight apart: the greatest of theirs.
  float of(const std::array<std::size_t, 4>& node, const std::array<double, 4>& weight) const {
    float most = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (weight[i] != 0) most = std::max(most, stiffness_[node[i]]);
    }
    return most;
  }
  /// `count` nodes from `to` on go on as those of `before` from `from` on.
  void take_over(const LayerStiffness& before, std::size_t from, std::size_t to, std::size_t count) {
    std::copy_n(before.stiffness_.begin() + static_cast<std::ptrdiff_t>(from), count,
                stiffness_.begin() + static_cast<std::ptrdiff_t>(to));
  }
  /// In the step in hand: makes stiffer all nodes for which `nodes` has another value than 0.
  void stiffen(const std::vector<std::uint8_t>& nodes);

  // As a step ends.

  /// Nothing is known yet of what is strained.
  void begin_adapting();
  /// A constraint between these nodes, those without weight apart, keeps this part of its gap.
  void keeps(double part, const std::array<std::size_t, 4>& node, const std::array<double, 4>& weight);
  /// The node was moved by no force, as none of its constraints was stiff enough.
  void struck(std::size_t node) { strain_[node] = Strain::hard; }
  /// Each node's stiffness follows what was told of it.
  void adapt();

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(stiffness_);
  }

 private:
  /// By how much a node's constraints are pressed: the gap is kept, half kept, or hardly.
  enum class Strain : std::uint8_t { none, some, hard };

  std::vector<float> stiffness_;  ///< at each node
  std::vector<Strain> strain_;    ///< of each node, in the step that ends
};

}  // namespace weft
