#include "cloth/contact/search/cell_features.h"

namespace weft {
namespace {

/// There is such a cell, and it is not torn.
bool whole(const TornLinks& torn, int row, int col) {
  const Grid& grid = torn.grid();
  return row >= 0 && col >= 0 && row < grid.rows - 1 && col < grid.cols - 1 && !torn.face_torn(row, col);
}

}  // namespace

unsigned owned_features(const Grid& grid, Cell cell) {
  const bool last_row = cell.row == grid.rows - 2, last_col = cell.col == grid.cols - 2;
  unsigned bits = node_bit(0) | edge_bit(0) | edge_bit(1) | edge_bit(2) | kTriangleBit;
  if (last_col) bits |= node_bit(1) | edge_bit(3);
  if (last_row) bits |= node_bit(2) | edge_bit(4);
  if (last_row && last_col) bits |= node_bit(3);
  return bits;
}

unsigned features_left(const TornLinks& torn, Cell cell) {
  const auto is_whole = [&](int down, int right) { return whole(torn, cell.row + down, cell.col + right); };
  const bool here = is_whole(0, 0), above = is_whole(-1, 0), before = is_whole(0, -1);
  unsigned bits = here ? edge_bit(2) | edge_bit(3) | edge_bit(4) | node_bit(3) | kTriangleBit : 0;
  if (here || above) bits |= edge_bit(0) | node_bit(1);
  if (here || before) bits |= edge_bit(1) | node_bit(2);
  if (here || above || before || is_whole(-1, -1)) bits |= node_bit(0);
  return bits & owned_features(torn.grid(), cell);
}

CellFeatures cell_features(const Grid& grid, std::uint32_t first, Cell cell, unsigned bits,
                           const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  CellFeatures features;
  const auto top = first + static_cast<std::uint32_t>(grid.index(cell.row, cell.col));
  const auto bottom = top + static_cast<std::uint32_t>(grid.stride);
  features.node = {top, top + 1, bottom, bottom + 1};
  features.bits = bits;
  for (std::size_t i = 0; i < 4; ++i) {
    features.at[i].extend(start[features.node[i]]);
    features.at[i].extend(end[features.node[i]]);
  }
  for (std::size_t i = 0; i < 5; ++i) {
    features.edge[i] = features.at[kCellEdges[i][0]];
    features.edge[i].extend(features.at[kCellEdges[i][1]]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    features.triangle[i] = features.edge[2];
    features.triangle[i].extend(features.at[kCellTriangles[i][i == 0 ? 1 : 2]]);
  }
  return features;
}

}  // namespace weft
