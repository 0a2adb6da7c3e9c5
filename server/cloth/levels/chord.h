#pragma once
#include <array>
#include <cstddef>

#include "cloth/core/grid.h"

namespace weft {

/// Where on a coarser grid a node of a finer one lies (Eq. 8): between up to four nodes, or at one.
struct Chord {
  std::array<std::size_t, 4> node{};  ///< indices into the coarse grid's arrays
  std::array<double, 4> weight{};     ///< 0: no such node
};

/// Of the fine node in this row and column, where the coarse grid has every `stride`-th row and column.
inline Chord chord_of(int row, int col, int stride, const Grid& coarse) {
  Chord chord;
  const int top = row / stride, left = col / stride;
  const double down = row % stride / double(stride), right = col % stride / double(stride);
  for (int i = 0; i < 4; ++i) {
    const int below = i / 2, beside = i % 2;
    const double weight = (below == 1 ? down : 1 - down) * (beside == 1 ? right : 1 - right);
    if (weight == 0) continue;
    const auto k = static_cast<std::size_t>(i);
    chord.node[k] = coarse.index(top + below, left + beside);
    chord.weight[k] = weight;
  }
  return chord;
}

/// Of a node of `was` on `now`, another level's grid of the same cloth: on a finer one it is a node, too.
inline Chord chord_of(std::size_t node, const Grid& was, const Grid& now) {
  const auto across = static_cast<std::size_t>(was.stride);
  const int row = static_cast<int>(node / across), col = static_cast<int>(node % across);
  if (was.rows > now.rows) return chord_of(row, col, (was.rows - 1) / (now.rows - 1), now);
  const int factor = (now.rows - 1) / (was.rows - 1);
  return {{now.index(factor * row, factor * col)}, {1}};
}

}  // namespace weft
