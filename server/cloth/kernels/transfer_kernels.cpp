#include "cloth/kernels/transfer_kernels.h"

#include "cloth/kernels/link_rows.h"

namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline void restrict_any(const Grid& fine_grid, const Real* fine,
                                                const Grid& coarse_grid, Real* coarse, RowRange rows,
                                                Real* work) {
  const std::ptrdiff_t stride = fine_grid.stride;
  Real* __restrict column = work + kRowAlign;
  column[-1] = Real(0);
  const int count = grouped(fine_grid.cols);
  for (int r = rows.begin; r < rows.end; ++r) {
    const Real* __restrict row = fine + r * stride * 2;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) column[c] = row[c] + (row[c - stride] + row[c + stride]) / 2;
    Real* __restrict out = coarse + r * std::ptrdiff_t{coarse_grid.stride};
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < coarse_grid.cols; ++c) {
      const Real* at = column + std::ptrdiff_t{2} * c;
      out[c] = at[0] + (at[-1] + at[1]) / 2;
    }
  }
}

template <class Real>
[[gnu::always_inline]] inline void prolong_any(const Grid& coarse_grid, const Real* coarse,
                                               const Grid& fine_grid, const Real* free, Real* fine,
                                               RowRange rows, Real* work) {
  const std::ptrdiff_t coarse_stride = coarse_grid.stride;
  Real* __restrict column = work;
  const int count = grouped(coarse_grid.cols);
  for (int r = rows.begin; r < rows.end; ++r) {
    const Real* __restrict above = coarse + r / 2 * coarse_stride;
    const Real* __restrict below = above + (r % 2) * coarse_stride;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) column[c] = (above[c] + below[c]) / 2;
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(fine_grid.index(r, 0));
    Real* __restrict out = fine + first;
    const Real* __restrict mask = free + first;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c + 1 < coarse_grid.cols; ++c) {
      const std::ptrdiff_t i = std::ptrdiff_t{2} * c;
      out[i] += mask[i] * column[c];
      out[i + 1] += mask[i + 1] * ((column[c] + column[c + 1]) / 2);
    }
    const int last = fine_grid.cols - 1;
    out[last] += mask[last] * column[coarse_grid.cols - 1];
  }
}

}  // namespace

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_TRANSFER_KERNELS(Real)                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void restrict_sum(const Grid& fine_grid, const Real* fine, const Grid& coarse_grid,  \
                                      Real* coarse, RowRange coarse_rows, Real* work) {                  \
    restrict_any<Real>(fine_grid, fine, coarse_grid, coarse, coarse_rows, work);                         \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void prolong_add(const Grid& coarse_grid, const Real* coarse, const Grid& fine_grid, \
                                     const Real* free, Real* fine, RowRange fine_rows, Real* work) {     \
    prolong_any<Real>(coarse_grid, coarse, fine_grid, free, fine, fine_rows, work);                      \
  }

WEFT_TRANSFER_KERNELS(float)
WEFT_TRANSFER_KERNELS(double)
#undef WEFT_TRANSFER_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
