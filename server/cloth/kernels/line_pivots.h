#pragma once
#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/node_blocks.h"

/// Pivots of the threads of line_kernels.h; for kernels' .cpp files only.
namespace weft::kernels {

/// share times m m^T.
template <class Real>
[[gnu::always_inline]] inline Block<Real> along(Real x, Real y, Real z, Real share) {
  const Real sx = share * x, sy = share * y, sz = share * z;
  return {sx * x, sx * y, sx * z, sy * y, sy * z, sz * z};
}

template <class Real>
[[gnu::always_inline]] inline Triple<Real> times(const Block<Real>& block, Real x, Real y, Real z) {
  return {block.xx * x + block.xy * y + block.xz * z, block.xy * x + block.yy * y + block.yz * z,
          block.xz * x + block.yz * y + block.zz * z};
}

}  // namespace weft::kernels
