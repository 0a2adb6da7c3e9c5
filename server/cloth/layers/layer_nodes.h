#pragma once
#include <vector>

#include "cloth/layers/features.h"

namespace weft {

/// The nodes of all cloths of a scene in one step, one cloth after the other: node i of cloth k's grid arrays
/// is first[k] + i here. In double precision, so that what is computed from them is not rounded again.
struct LayerNodes {
  std::vector<std::uint32_t> first;  ///< of each cloth, and behind them the number of all
  std::vector<Vec3> start;           ///< where the step began, m
  std::vector<Vec3> end;             ///< where it ends, or is expected to, m
  std::vector<Vec3> velocity;        ///< as the step began, m/s
  std::vector<double> inverse_mass;  ///< 1/kg; 0 where pinned, and for what is not a node
  /// Belongs to a triangle that another one passes through: none of its pairs is looked at.
  std::vector<char> tangled;
};

/// The points of a pair's nodes.
inline FourPoints points_of(const FeaturePair& pair, const std::vector<Vec3>& of) {
  return {of[pair.node[0]], of[pair.node[1]], of[pair.node[2]], of[pair.node[3]]};
}

}  // namespace weft
