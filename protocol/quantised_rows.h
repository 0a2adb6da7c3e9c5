#pragma once
/// One axis of a grid on its lattice, row by row: what both codecs of grids encode.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "protocol/grid_codec.h"

namespace weft::protocol {

/// A row's values side by side: the storage itself where it is so already, else copied into `copy`, of the
/// grid's columns.
inline const float* row_of(const GridView& grid, std::size_t axis, int row, std::vector<float>& copy) {
  const float* first = grid.data[axis] + row * grid.row_step;
  if (grid.col_step == 1) return first;
  for (int c = 0; c < grid.cols; ++c) copy[static_cast<std::size_t>(c)] = first[c * grid.col_step];
  return copy.data();
}

/// Small for numbers near 0 of either sign: 0, -1, 1, -2 are 0, 1, 2, 3.
inline std::uint32_t zigzag(std::int32_t e) {
  return static_cast<std::uint32_t>(e) << 1 ^ static_cast<std::uint32_t>(e >> 31);
}
inline std::int32_t unzigzag(std::uint32_t z) {
  return static_cast<std::int32_t>(z >> 1) ^ -static_cast<std::int32_t>(z & 1);
}

class QuantisedRows {
 public:
  QuantisedRows(const GridView& grid, std::size_t axis, const Quantisation& quantisation)
      : grid_(grid),
        axis_(axis),
        origin_(double(quantisation.origin[axis]) - grid.place[axis]),
        per_quantum_(1.0 / double(quantisation.quantum)),  // exact: a power of two
        top_(double((1 << quantisation.bits) - 1)),
        copy_(grid.col_step == 1 ? 0 : static_cast<std::size_t>(grid.cols)) {}

  /// q = round((p - origin) / quantum), halves up, of row r; `to` has the grid's columns.
  void read(int r, std::int32_t* to) {
    const float* row = row_of(grid_, axis_, r, copy_);
    for (int c = 0; c < grid_.cols; ++c) {
      const double q = (double(row[c]) - origin_) * per_quantum_ + 0.5;
      // Clamped in this order, a NaN becomes 0 instead of undefined behaviour.
      to[c] = static_cast<std::int32_t>(std::min(std::max(0.0, q), top_));
    }
  }

 private:
  const GridView& grid_;
  std::size_t axis_;
  double origin_, per_quantum_, top_;
  std::vector<float> copy_;
};

}  // namespace weft::protocol
