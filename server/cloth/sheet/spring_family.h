#pragma once
#include <limits>

namespace weft {

/// Where a spring stiffens: longer than `length`, each further metre takes `stiffening` times as much force.
struct SpringLimit {
  double length = std::numeric_limits<double>::infinity();  ///< m
  double stiffening = 1;
};

/// One kind of spring between node (r, c) and node (r + rows, c + cols), all of one rest length. Fig. 1's
/// three kinds make six families: structural (0,1) (1,0), shear (1,1) (1,-1), bending (0,2) (2,0).
struct SpringFamily {
  int rows = 0, cols = 0;  ///< offset to the other end; rows >= 0, cols may be negative
  double rest_length = 0;  ///< m
  double stiffness = 0;    ///< N/m, of a spring away from the border
  double border_share =
      1;  ///< stiffness of a spring lying in the border row or column, relative: 1 (paper), 0.5
  SpringLimit limit = {};

  /// Stiffness of the spring whose first end is node (r, c), on a grid of so many rows and columns.
  double stiffness_at(int r, int c, int grid_rows, int grid_cols) const {
    const bool in_border_row = rows == 0 && (r == 0 || r == grid_rows - 1);
    const bool in_border_column = cols == 0 && (c == 0 || c == grid_cols - 1);
    return in_border_row || in_border_column ? border_share * stiffness : stiffness;
  }
};

}  // namespace weft
