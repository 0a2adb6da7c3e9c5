/// Line solves along the rows, which are turned over in groups.
#include <algorithm>
#include <cstring>

#include "cloth/kernels/line_kernels.h"
#include "cloth/kernels/line_pivots.h"

namespace weft::kernels {
namespace {

constexpr int kLines = kWeftLines;
/// Of a node in a group of weft threads: E's six numbers, m, and E m.
constexpr int kFactors = 12;

template <class Real>
using Four [[gnu::vector_size(4 * sizeof(Real))]] = Real;

/// Calls put(i, column i) with four by four values, turned over in registers.
template <class Real, class Put>
[[gnu::always_inline]] inline void transpose_four(const Real* from, std::ptrdiff_t stride, Put put) {
  Four<Real> a, b, c, d;
  std::memcpy(&a, from, sizeof a);
  std::memcpy(&b, from + stride, sizeof b);
  std::memcpy(&c, from + 2 * stride, sizeof c);
  std::memcpy(&d, from + 3 * stride, sizeof d);
  const Four<Real> ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                   cd = __builtin_shufflevector(c, d, 0, 4, 1, 5),
                   ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7),
                   cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  put(0, __builtin_shufflevector(ab, cd, 0, 1, 4, 5));
  put(1, __builtin_shufflevector(ab, cd, 2, 3, 6, 7));
  put(2, __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5));
  put(3, __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7));
}

/// to[c * apart + lane] = from[row first + lane][c], or `beyond` where the grid has no such row, up to the
/// whole group of columns.
template <class Real>
[[gnu::always_inline]] inline void transpose_in(const Grid& grid, const Real* from, int first, Real* to,
                                                std::ptrdiff_t apart, Real beyond = 0) {
  const int lanes = std::min(kLines, grid.rows - first), whole = lanes / 4 * 4;
  const std::ptrdiff_t stride = grid.stride;
  const Real* rows = from + first * stride;
  for (int lane = 0; lane < whole; lane += 4) {
    for (int c = 0; c < grid.cols; c += 4) {
      Real* corner = to + c * apart + lane;
      transpose_four(rows + lane * stride + c, stride,
                     [&](std::ptrdiff_t i, const Four<Real>& column)
                         WEFT_INLINE_LAMBDA { std::memcpy(corner + i * apart, &column, sizeof column); });
    }
  }
  for (int lane = whole; lane < kLines; ++lane) {
    for (int c = 0; c < grid.cols; ++c) {
      to[c * apart + lane] = lane < lanes ? rows[lane * stride + c] : beyond;
    }
  }
}

/// sum[row first + lane][c] = x there + q[c * apart + lane].
template <class Real>
[[gnu::always_inline]] inline void add_transposed(const Grid& grid, const Real* q, std::ptrdiff_t apart,
                                                  int first, const Real* x, Real* sum) {
  const int lanes = std::min(kLines, grid.rows - first), whole = lanes / 4 * 4;
  const std::ptrdiff_t stride = grid.stride;
  for (int lane = 0; lane < whole; lane += 4) {
    for (int c = 0; c < grid.cols; c += 4) {
      const std::ptrdiff_t corner = (first + lane) * stride + c;
      transpose_four(q + c * apart + lane, apart,
                     [&](std::ptrdiff_t i, const Four<Real>& change) WEFT_INLINE_LAMBDA {
                       Four<Real> values;
                       std::memcpy(&values, x + corner + i * stride, sizeof values);
                       values += change;
                       std::memcpy(sum + corner + i * stride, &values, sizeof values);
                     });
    }
  }
  for (int lane = whole; lane < lanes; ++lane) {
    const std::ptrdiff_t row = (first + lane) * stride;
    for (int c = 0; c < grid.cols; ++c) sum[row + c] = x[row + c] + q[c * apart + lane];
  }
}

template <class Real>
[[gnu::always_inline]] inline void factorise_weft_any(const LinkMatrix<Real, SpringLinks<Real>>& matrix,
                                                      const Blocks<Real>& nodes, Real* factors, int first,
                                                      Real* work) {
  const Grid& grid = matrix.grid;
  const SpringLinks<Real>& link = matrix.links.along_u;
  // All but E m, which is found below.
  const Real* from[] = {nodes.xx, nodes.xy, nodes.xz, nodes.yy, nodes.yz, nodes.zz, link.x, link.y, link.z};
  constexpr std::ptrdiff_t kApart = std::ptrdiff_t{kFactors} * kLines;
  Real* to = factors;
  for (const Real* numbers : from) {
    transpose_in(grid, numbers, first, to, kApart);
    to += kLines;
  }
  Real* least = work;
  Real* free = work + static_cast<std::ptrdiff_t>(grouped(grid.cols)) * kLines;
  transpose_in(grid, matrix.diagonal, first, least, kLines, Real(1));
  transpose_in(grid, matrix.free, first, free, kLines);
  Real less[6][kLines]{};  // what a pivot is less than its block by, because of the link from the left
  for (int c = 0; c < grid.cols; ++c) {
    Real* __restrict f = factors + c * kApart;
    const Real* __restrict l = least + c * kLines;
    const Real* __restrict m = free + c * kLines;
    WEFT_INDEPENDENT_ITERATIONS
    for (int i = 0; i < kLines; ++i) {
      const Real trace = f[i] + f[3 * kLines + i] + f[5 * kLines + i];
      const Block<Real> pivot{f[i] - less[0][i],
                              f[kLines + i] - less[1][i],
                              f[2 * kLines + i] - less[2][i],
                              f[3 * kLines + i] - less[3][i],
                              f[4 * kLines + i] - less[4][i],
                              f[5 * kLines + i] - less[5][i]};
      const Block<Real> e = inverted(pivot, l[i], m[i], 1 / trace);
      f[i] = e.xx;
      f[kLines + i] = e.xy;
      f[2 * kLines + i] = e.xz;
      f[3 * kLines + i] = e.yy;
      f[4 * kLines + i] = e.yz;
      f[5 * kLines + i] = e.zz;
      const Real x = f[6 * kLines + i], y = f[7 * kLines + i], z = f[8 * kLines + i];
      const Triple<Real> w = times(e, x, y, z);
      f[9 * kLines + i] = w.x;
      f[10 * kLines + i] = w.y;
      f[11 * kLines + i] = w.z;
      const Block<Real> next = along(x, y, z, w.x * x + w.y * y + w.z * z);
      less[0][i] = next.xx;
      less[1][i] = next.xy;
      less[2][i] = next.xz;
      less[3][i] = next.yy;
      less[4][i] = next.yz;
      less[5][i] = next.zz;
    }
  }
}

/// E v of lane i.
template <class Real>
[[gnu::always_inline]] inline Triple<Real> by_pivot(const Real* f, int i, Real x, Real y, Real z) {
  const Real xy = f[kLines + i], xz = f[2 * kLines + i], yz = f[4 * kLines + i];
  return {f[i] * x + xy * y + xz * z, xy * x + f[3 * kLines + i] * y + yz * z,
          xz * x + yz * y + f[5 * kLines + i] * z};
}

/// m . v of lane i.
template <class Real>
[[gnu::always_inline]] inline Real along_link(const Real* f, int i, Real x, Real y, Real z) {
  return f[6 * kLines + i] * x + f[7 * kLines + i] * y + f[8 * kLines + i] * z;
}

template <class Real>
[[gnu::always_inline]] inline double solve_weft_any(const Grid& grid, const Real* factors, Real damping,
                                                    const WeftSolve<Real>& fields, int first, Real* work) {
  constexpr std::ptrdiff_t kApart = 3 * std::ptrdiff_t{kLines};
  transpose_in(grid, fields.r.x, first, work, kApart);
  transpose_in(grid, fields.r.y, first, work + kLines, kApart);
  transpose_in(grid, fields.r.z, first, work + 2 * kLines, kApart);
  Real pull[3][kLines]{};  // of the nodes to the left
  for (int c = 0; c < grid.cols; ++c) {
    const Real* __restrict f = factors + c * std::ptrdiff_t{kFactors} * kLines;
    Real* __restrict q = work + c * kApart;
    WEFT_INDEPENDENT_ITERATIONS
    for (int i = 0; i < kLines; ++i) {
      const Triple<Real> y = by_pivot(f, i, damping * q[i] + pull[0][i], damping * q[kLines + i] + pull[1][i],
                                      damping * q[2 * kLines + i] + pull[2][i]);
      q[i] = y.x;
      q[kLines + i] = y.y;
      q[2 * kLines + i] = y.z;
      const Real s = along_link(f, i, y.x, y.y, y.z);
      pull[0][i] = s * f[6 * kLines + i];
      pull[1][i] = s * f[7 * kLines + i];
      pull[2][i] = s * f[8 * kLines + i];
    }
  }
  for (int c = grid.cols - 2; c >= 0; --c) {
    const Real* __restrict f = factors + c * std::ptrdiff_t{kFactors} * kLines;
    Real* __restrict q = work + c * kApart;
    const Real* __restrict right = q + kApart;
    WEFT_INDEPENDENT_ITERATIONS
    for (int i = 0; i < kLines; ++i) {
      const Real s = along_link(f, i, right[i], right[kLines + i], right[2 * kLines + i]);
      q[i] += s * f[9 * kLines + i];
      q[kLines + i] += s * f[10 * kLines + i];
      q[2 * kLines + i] += s * f[11 * kLines + i];
    }
  }
  add_transposed(grid, work, kApart, first, fields.x.x, fields.z.x);
  add_transposed(grid, work + kLines, kApart, first, fields.x.y, fields.z.y);
  add_transposed(grid, work + 2 * kLines, kApart, first, fields.x.z, fields.z.z);
  return dot_rows<Real>(grid, fields.b, fields.z, {first, std::min(first + kLines, grid.rows)});
}

}  // namespace

std::size_t line_work_size(const Grid& grid) {
  return 6 * static_cast<std::size_t>(std::max(grid.stride, kLines * grouped(grid.cols)));
}

std::size_t weft_factors_size(const Grid& grid) {
  return static_cast<std::size_t>(kFactors) * kLines * static_cast<std::size_t>(grouped(grid.cols));
}

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_WEFT_LINE_KERNELS(Real)                                                                       \
  template <>                                                                                              \
  WEFT_MULTIVERSION void factorise_weft(const LinkMatrix<Real, SpringLinks<Real>>& matrix,                 \
                                        const Blocks<Real>& nodes, Real* factors, int first, Real* work) { \
    factorise_weft_any<Real>(matrix, nodes, factors, first, work);                                         \
  }                                                                                                        \
  template <>                                                                                              \
  WEFT_MULTIVERSION double solve_weft(const Grid& grid, const Real* factors, Real damping,                 \
                                      const WeftSolve<Real>& fields, int first, Real* work) {              \
    return solve_weft_any<Real>(grid, factors, damping, fields, first, work);                              \
  }

WEFT_WEFT_LINE_KERNELS(float)
WEFT_WEFT_LINE_KERNELS(double)
#undef WEFT_WEFT_LINE_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
