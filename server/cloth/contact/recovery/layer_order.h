#pragma once
#include <span>
#include <vector>

#include "cloth/core/vec3.h"

namespace weft {

/// Two layers that lay on each other on finer grids, by the nodes of those that they have now.
struct OrderedLayers {
  struct Node {
    std::uint32_t node;
    double weight;  ///< so that the sum of weight x leads from the second layer to the first
  };
  std::vector<Node> nodes;  ///< each once
  Vec3 normal;              ///< unit, from the second to the first, as they lay
  double apart = 0;         ///< that they are to be at least, along the normal, m
};

/// After merges (levels/refine.h) layers may have passed through each other, by chords of folds that both lie
/// in. Moves free nodes, by their inverse masses, 1/kg, until each pair is in the order in which it was.
/// Returns whether any has moved.
bool keep_order(std::span<const OrderedLayers> layers, const std::vector<double>& inverse_mass,
                std::vector<Vec3>& positions);

}  // namespace weft
