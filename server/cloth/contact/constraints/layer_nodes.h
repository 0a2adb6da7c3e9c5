#pragma once
#include <vector>

#include "cloth/contact/search/features.h"
#include "cloth/core/grid.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// The nodes of all cloths of a scene in one step, one cloth after the other: node i of cloth k's grid arrays
/// is first[k] + i here. In the world, wherever the cloths' own places are, and in double precision, so that
/// what is computed from them is not rounded again.
struct LayerNodes {
  std::vector<std::uint32_t> first;  ///< of each cloth, and behind them the number of all
  std::vector<Vec3> start;           ///< where the step began, m
  std::vector<Vec3> end;             ///< where it ends, or is expected to, m
  std::vector<Vec3> velocity;        ///< as the step began, m/s
  std::vector<Vec3> acceleration;    ///< that lasts, of the last step but for layers (ClothContact), m/s2
  /// By which all but layers withstood other cloths' layers, m/s2: a mean of the steps before, of which each
  /// counts half as much as the one after it (ClothContact).
  std::vector<Vec3> support;
  std::vector<double> inverse_mass;  ///< 1/kg; 0 where pinned, and for what is not a node
  std::vector<char> lies;            ///< went on lying on a solid as the last step ended
  /// Belongs to a triangle that another one passes through: none of its pairs is looked at.
  std::vector<char> tangled;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first, start, end, velocity, acceleration, support, inverse_mass, lies, tangled);
  }
};

/// The points of a pair's nodes.
inline FourPoints points_of(const FeaturePair& pair, const std::vector<Vec3>& of) {
  return {of[pair.node[0]], of[pair.node[1]], of[pair.node[2]], of[pair.node[3]]};
}

/// The side of a sheet, 0 or 1, on which `direction` leads away from its node `i`; `position` are its nodes'.
/// `torn` is what is cut of it, or nullptr: nodes beyond say nothing.
inline int side_of_sheet(const Grid& grid, const Vec3* position, std::size_t i, const Vec3& direction,
                         const TornLinks* torn) {
  const int r = static_cast<int>(i) / grid.stride, c = static_cast<int>(i) % grid.stride;
  const auto x = [&](bool is_there, const Link& link, int row, int col) -> const Vec3& {
    return is_there && !(torn && torn->torn(link)) ? position[grid.index(row, col)] : position[i];
  };
  const Vec3 along_v = x(r + 1 < grid.rows, {r, c, false}, r + 1, c) - x(r > 0, {r - 1, c, false}, r - 1, c),
             along_u = x(c + 1 < grid.cols, {r, c, true}, r, c + 1) - x(c > 0, {r, c - 1, true}, r, c - 1);
  return along_v.cross(along_u).dot(direction) > 0 ? 1 : 0;
}

/// Crossing edges are held apart by this part of the thickness: between layers that lie flat on each other
/// the nodes alone do it.
constexpr double kEdgePart = 0.5;

}  // namespace weft
