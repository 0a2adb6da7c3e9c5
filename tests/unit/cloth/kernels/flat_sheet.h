#pragma once
#include "cloth/core/grid.h"

namespace weft::fixture {

/// Node (r, c) at (c width, -r height, 0), m: flat, its face towards +z.
inline VectorField<double> flat_sheet(const Grid& grid, double width, double height) {
  VectorField<double> position(grid);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      position.x.at(r, c) = c * width;
      position.y.at(r, c) = -r * height;
    }
  }
  return position;
}

/// How many of the four cells around a node there are.
inline int cells_at(const Grid& grid, int r, int c) {
  const int rows = (r > 0 ? 1 : 0) + (r + 1 < grid.rows ? 1 : 0);
  const int cols = (c > 0 ? 1 : 0) + (c + 1 < grid.cols ? 1 : 0);
  return rows * cols;
}

}  // namespace weft::fixture
