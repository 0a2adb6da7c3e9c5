#pragma once
#include <cmath>
#include <limits>

#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/spring_kernels.h"

/// How springs are linearised row by row; for kernels' .cpp files only.
namespace weft::kernels::linearise_rows {

/// Springs of one family that start in one row; `other` is where their second ends lie from the first.
template <class Real, bool kLimited>
[[gnu::always_inline]] inline void linearise_row(const SpringColumns<Real>& springs, Real excess, Real share,
                                                 const Components<const Real>& position, std::ptrdiff_t first,
                                                 std::ptrdiff_t other, int count, Real axial,
                                                 const SpringLinks<Real>& links) {
  const Real* __restrict stiffness = springs.stiffness;
  const Real rest_length = springs.rest_length, limit_length = springs.limit_length;
  const Real* __restrict x = position.x + first;
  const Real* __restrict y = position.y + first;
  const Real* __restrict z = position.z + first;
  Real* __restrict a = links.a + first;
  Real* __restrict mx = links.x + first;
  Real* __restrict my = links.y + first;
  Real* __restrict mz = links.z + first;
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    const Real dx = x[c] - x[c + other], dy = y[c] - y[c + other], dz = z[c] - z[c + other];
    // Coincident ends have no direction: they are held by nothing until they part.
    const Real length = std::sqrt(dx * dx + dy * dy + dz * dz + std::numeric_limits<Real>::min());
    const Real k = share * stiffness[c];
    const Real stretch = length - rest_length;
    // max(0, stretch) without a branch, which the compiler would keep.
    Real longer = (stretch + std::abs(stretch)) / 2, stiffness_along = axial * k;
    if constexpr (kLimited) {
      const Real past = length - limit_length, over = (past + std::abs(past)) / 2;
      longer += excess * over;
      stiffness_along += excess * k * unit_step(past, over);
    }
    const Real sideways = k * longer / length;
    const Real along = std::sqrt(stiffness_along - sideways) / length;
    a[c] = sideways;
    mx[c] = along * dx;
    my[c] = along * dy;
    mz[c] = along * dz;
  }
}

template <class Real, bool kLimited, bool kTorn>
[[gnu::always_inline]] inline void linearise(const SpringLattice<Real>& springs, const Grid& grid,
                                             const Components<const Real>& position, Real axial,
                                             const LinkFamilies<SpringLinks<Real>>& links, RowRange rows) {
  const std::ptrdiff_t stride = grid.stride;
  const int count = grouped(grid.cols);
  for (int r = rows.begin; r < rows.end; ++r) {
    const std::ptrdiff_t first = r * stride;
    const bool last = r + 1 == grid.rows;
    const Real share = r == 0 || last ? springs.border_row_share : Real(1);
    const SpringLattice<Real>& own = springs_of_row<kTorn>(springs, r);
    const auto row = [&](const SpringColumns<Real>& family, Real row_share, std::ptrdiff_t other,
                         const SpringLinks<Real>& out) WEFT_INLINE_LAMBDA {
      linearise_row<Real, kLimited>(family, springs.excess, row_share, position, first, other, count, axial,
                                    out);
    };
    const auto bending_row = [&](const SpringColumns<Real>& family, Real row_share, std::ptrdiff_t other,
                                 const SpringLinks<Real>& out) WEFT_INLINE_LAMBDA {
      linearise_row<Real, false>(family, 0, row_share, position, first, other, count, axial, out);
    };
    row(own.along_u, share, 1, links.along_u);
    if (links.has_bending) {
      bending_row(own.bending_u, share, 2, links.bending_u);
      if (r + 2 < grid.rows) bending_row(own.bending_v, Real(1), 2 * stride, links.bending_v);
    }
    if (last) break;
    row(own.along_v, Real(1), stride, links.along_v);
    row(own.falling, Real(1), stride + 1, links.falling);
    row(own.rising, Real(1), stride - 1, links.rising);
  }
}

}  // namespace weft::kernels::linearise_rows
