#include "cloth/kernels/contact_kernels.h"

#include "cloth/multiversion.h"

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

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_inside_any(const Components<const Real>& position, int rows,
                                                            int stride, int cols, const Sphere& ball) {
  std::uint32_t result = 0;
  for (int r = 0; r < rows; ++r) {
    const std::size_t first = static_cast<std::size_t>(r) * static_cast<std::size_t>(stride);
    const Real* x = position.x + first;
    const Real* y = position.y + first;
    const Real* z = position.z + first;
    std::int64_t inside = 0;  // as wide as the doubles compared
    for (int c = 0; c < cols; ++c) {
      const double dx = static_cast<double>(x[c]) - ball.x;
      const double dy = static_cast<double>(y[c]) - ball.y;
      const double dz = static_cast<double>(z[c]) - ball.z;
      inside |= dx * dx + dy * dy + dz * dz < ball.squared_radius ? 1 : 0;
    }
    result |= static_cast<std::uint32_t>(inside) << r;
  }
  return result;
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

WEFT_MULTIVERSION std::uint32_t rows_inside(Components<const float> position, int rows, int stride, int cols,
                                            const Sphere& ball) {
  return rows_inside_any(position, rows, stride, cols, ball);
}
WEFT_MULTIVERSION std::uint32_t rows_inside(Components<const double> position, int rows, int stride, int cols,
                                            const Sphere& ball) {
  return rows_inside_any(position, rows, stride, cols, ball);
}

}  // namespace weft::kernels
