#pragma once

namespace weft::kernels {

/// Smallest and largest of `rows` rows, column by column; `values` is the first row's start.
void column_extents(const float* values, int rows, int stride, int cols, float* low, float* high);
void column_extents(const double* values, int rows, int stride, int cols, double* low, double* high);

}  // namespace weft::kernels
