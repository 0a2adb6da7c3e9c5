#pragma once
#include <array>
#include <cstddef>
#include <cstdlib>

#include "cloth/core/grid.h"

namespace weft {

/// Where on a coarser grid a node of a finer one lies (Eq. 8): between up to four nodes, or at one.
struct Chord {
  std::array<std::size_t, 4> node{};  ///< indices into the coarse grid's arrays
  std::array<double, 4> weight{};     ///< 0: no such node
};

/// Calls visit(row, col, weight) for the nodes between which a node lies, as Eq. 8 weights them; their rows
/// and columns are `stride` apart.
template <class Visit>
void for_each_around(int row, int col, int stride, Visit visit) {
  const int top = row - row % stride, left = col - col % stride;
  for (const int r : {top, top + stride}) {
    for (const int c : {left, left + stride}) {
      const double weight =
          (1 - std::abs(row - r) / double(stride)) * (1 - std::abs(col - c) / double(stride));
      if (weight != 0) visit(r, c, weight);
    }
  }
}

/// Of the fine node in this row and column, where the coarse grid has every `stride`-th row and column.
inline Chord chord_of(int row, int col, int stride, const Grid& coarse) {
  Chord chord;
  std::size_t count = 0;
  for_each_around(row, col, stride, [&](int r, int c, double weight) {
    chord.node[count] = coarse.index(r / stride, c / stride);
    chord.weight[count++] = weight;
  });
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
