#include "cloth/kernels/extent_kernels.h"

#include <cstddef>

#include "cloth/core/multiversion.h"

// Apart from contact_kernels.cpp: winds with zones have it without contact.
namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline void column_extents_any(const Real* __restrict values, int rows, int stride,
                                                      int cols, Real* __restrict low, Real* __restrict high) {
  for (int c = 0; c < cols; ++c) low[c] = high[c] = values[c];
  for (int r = 1; r < rows; ++r) {
    const Real* __restrict row = values + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride);
    for (int c = 0; c < cols; ++c) {
      low[c] = row[c] < low[c] ? row[c] : low[c];
      high[c] = row[c] > high[c] ? row[c] : high[c];
    }
  }
}

}  // namespace

WEFT_MULTIVERSION void column_extents(const float* values, int rows, int stride, int cols, float* low,
                                      float* high) {
  column_extents_any(values, rows, stride, cols, low, high);
}
WEFT_MULTIVERSION void column_extents(const double* values, int rows, int stride, int cols, double* low,
                                      double* high) {
  column_extents_any(values, rows, stride, cols, low, high);
}

}  // namespace weft::kernels
