#pragma once
#include <cstdint>

#include "cloth/kernels/components.h"

namespace weft::kernels {

/// Smallest and largest of `rows` rows, column by column; `values` is the first row's start.
void column_extents(const float* values, int rows, int stride, int cols, float* low, float* high);
void column_extents(const double* values, int rows, int stride, int cols, double* low, double* high);

/// A ball, in double whatever the nodes' precision.
struct Sphere {
  double x, y, z;
  double squared_radius;
};

/// Which of a block's rows have a node inside the ball: bit r for row r. `position` is the block's first
/// node; at most 32 rows.
std::uint32_t rows_inside(Components<const float> position, int rows, int stride, int cols,
                          const Sphere& ball);
std::uint32_t rows_inside(Components<const double> position, int rows, int stride, int cols,
                          const Sphere& ball);

}  // namespace weft::kernels
