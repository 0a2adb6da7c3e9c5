#pragma once
#include "cloth/kernels/link_kernels.h"

/// Between a grid and the next coarser one, whose nodes are every second of its own: split's bilinear
/// interpolation (Eq. 8) and its transpose. Arrays are as link_kernels.h says, with their rows of zeros.
namespace weft::kernels {

/// coarse = P^T fine on the coarse rows: each fine value goes to the coarse nodes it is interpolated from, by
/// their weights. `work` has a row of fine_grid.stride + 2 kRowAlign scalars.
template <class Real>
void restrict_sum(const Grid& fine_grid, const Real* fine, const Grid& coarse_grid, Real* coarse,
                  RowRange coarse_rows, Real* work);

/// fine += free P coarse on the fine rows.
template <class Real>
void prolong_add(const Grid& coarse_grid, const Real* coarse, const Grid& fine_grid, const Real* free,
                 Real* fine, RowRange fine_rows, Real* work);

}  // namespace weft::kernels
