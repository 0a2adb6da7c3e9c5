/// Line solves down the columns, side by side as they lie.
#include <algorithm>
#include <limits>

#include "cloth/kernels/line_kernels.h"
#include "cloth/kernels/line_pivots.h"

namespace weft::kernels {
namespace {

/// What a pivot may lose to rounding, in units of the scalar's last digit of its node's block: so much is
/// added to that beforehand.
constexpr int kRounding = 128;

template <class Real, bool kBending, bool kBlocks>
[[gnu::always_inline]] inline void factorise_warp_rows(const LinkMatrix<Real, SpringLinks<Real>>& matrix,
                                                       const Blocks<Real>& nodes,
                                                       const LineFactors<Real>& factors, ColumnRange columns,
                                                       Real* work) {
  const Grid& grid = matrix.grid;
  const int end = std::min(columns.end, grid.cols);
  const std::ptrdiff_t size = grid.stride;
  // What a node's pivot is less than its block by, because of the link from above.
  const Blocks<Real> less{work,           work + size, work + 2 * size, work + 3 * size, work + 4 * size,
                          work + 5 * size};
  std::fill_n(work, 6 * size, Real(0));
  const SpringLinks<Real>& link = matrix.links.along_v;
  for (int r = 0; r < grid.rows; ++r) {
    const std::ptrdiff_t first = r * size;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = columns.begin; c < end; ++c) {
      const std::ptrdiff_t i = first + c;
      Block<Real> pivot = node_block<Real, kBending, kBlocks>(matrix, i);
      const Real trace = pivot.xx + pivot.yy + pivot.zz;
      const Real rounding = kRounding * std::numeric_limits<Real>::epsilon() * trace;
      pivot.xx += rounding;
      pivot.yy += rounding;
      pivot.zz += rounding;
      store(nodes, i, pivot);
      pivot.add(block_at(less, c), Real(-1));
      const Block<Real> e = inverted(pivot, matrix.diagonal[i], matrix.free[i], 1 / trace);
      store(factors.inverse, i, e);
      const Real x = link.x[i], y = link.y[i], z = link.z[i];
      const Triple<Real> w = times(e, x, y, z);
      factors.along.x[i] = w.x;
      factors.along.y[i] = w.y;
      factors.along.z[i] = w.z;
      store(less, c, along(x, y, z, w.x * x + w.y * y + w.z * z));
    }
  }
}

template <class Real>
[[gnu::always_inline]] inline void factorise_warp_any(const LinkMatrix<Real, SpringLinks<Real>>& matrix,
                                                      const Blocks<Real>& nodes,
                                                      const LineFactors<Real>& factors, ColumnRange columns,
                                                      Real* work) {
  const bool bending = matrix.links.has_bending;
  if (bending && matrix.has_blocks) {
    factorise_warp_rows<Real, true, true>(matrix, nodes, factors, columns, work);
  } else if (bending) {
    factorise_warp_rows<Real, true, false>(matrix, nodes, factors, columns, work);
  } else if (matrix.has_blocks) {
    factorise_warp_rows<Real, false, true>(matrix, nodes, factors, columns, work);
  } else {
    factorise_warp_rows<Real, false, false>(matrix, nodes, factors, columns, work);
  }
}

template <class Real, bool kAdd>
[[gnu::always_inline]] inline void solve_warp_columns(const LinkMatrix<Real, SpringLinks<Real>>& matrix,
                                                      const LineFactors<Real>& factors, Real damping,
                                                      const WarpSolve<Real>& fields, ColumnRange columns,
                                                      Real* work) {
  const std::ptrdiff_t stride = matrix.grid.stride;
  const Components<Real> pull{work, work + stride, work + 2 * stride};  // of the node above
  set_zero(pull, columns.begin, columns.end);
  const SpringLinks<Real>& link = matrix.links.along_v;
  const Components<const Real> r = fields.r;
  const Components<Real> change = fields.change, x = fields.x;
  for (int row = 0; row < matrix.grid.rows; ++row) {
    const std::ptrdiff_t first = row * stride;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = columns.begin; c < columns.end; ++c) {
      const std::ptrdiff_t i = first + c;
      const Triple<Real> y = force_of(factors.inverse, i, damping * r.x[i] + pull.x[c],
                                      damping * r.y[i] + pull.y[c], damping * r.z[i] + pull.z[c]);
      change.x[i] = y.x;
      change.y[i] = y.y;
      change.z[i] = y.z;
      const Real mx = link.x[i], my = link.y[i], mz = link.z[i];
      const Real s = mx * y.x + my * y.y + mz * y.z;
      pull.x[c] = s * mx;
      pull.y[c] = s * my;
      pull.z[c] = s * mz;
    }
  }
  // Below the last row there is a row of zeros.
  for (int row = matrix.grid.rows - 1; row >= 0; --row) {
    const std::ptrdiff_t first = row * stride;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = columns.begin; c < columns.end; ++c) {
      const std::ptrdiff_t i = first + c, below = i + stride;
      const Real s = link.x[i] * change.x[below] + link.y[i] * change.y[below] + link.z[i] * change.z[below];
      const Real vx = change.x[i] + s * factors.along.x[i], vy = change.y[i] + s * factors.along.y[i],
                 vz = change.z[i] + s * factors.along.z[i];
      change.x[i] = vx;
      change.y[i] = vy;
      change.z[i] = vz;
      if constexpr (kAdd) {
        x.x[i] += vx;
        x.y[i] += vy;
        x.z[i] += vz;
      }
    }
  }
}

template <class Real>
[[gnu::always_inline]] inline void solve_warp_any(const LinkMatrix<Real, SpringLinks<Real>>& matrix,
                                                  const LineFactors<Real>& factors, Real damping,
                                                  const WarpSolve<Real>& fields, ColumnRange columns,
                                                  Real* work) {
  if (fields.x.x != nullptr) {
    solve_warp_columns<Real, true>(matrix, factors, damping, fields, columns, work);
  } else {
    solve_warp_columns<Real, false>(matrix, factors, damping, fields, columns, work);
  }
}

}  // namespace

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_WARP_LINE_KERNELS(Real)                                                                  \
  template <>                                                                                         \
  WEFT_MULTIVERSION void factorise_warp(const LinkMatrix<Real, SpringLinks<Real>>& matrix,            \
                                        const Blocks<Real>& nodes, const LineFactors<Real>& factors,  \
                                        ColumnRange columns, Real* work) {                            \
    factorise_warp_any<Real>(matrix, nodes, factors, columns, work);                                  \
  }                                                                                                   \
  template <>                                                                                         \
  WEFT_MULTIVERSION void solve_warp(const LinkMatrix<Real, SpringLinks<Real>>& matrix,                \
                                    const LineFactors<Real>& factors, Real damping,                   \
                                    const WarpSolve<Real>& fields, ColumnRange columns, Real* work) { \
    solve_warp_any<Real>(matrix, factors, damping, fields, columns, work);                            \
  }

WEFT_WARP_LINE_KERNELS(float)
WEFT_WARP_LINE_KERNELS(double)
#undef WEFT_WARP_LINE_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
