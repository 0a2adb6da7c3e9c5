#pragma once
#include <cstddef>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/link_kernels.h"

/// 3 x 3 blocks of the linearised sheet, one node at a time; for kernels' .cpp files only.
namespace weft::kernels {

template <class Real>
struct Block {
  Real xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  [[gnu::always_inline]] void add(const Block& other, Real weight) {
    xx += weight * other.xx;
    xy += weight * other.xy;
    xz += weight * other.xz;
    yy += weight * other.yy;
    yz += weight * other.yz;
    zz += weight * other.zz;
  }
};

template <class Real>
[[gnu::always_inline]] inline Block<Real> block_at(const SpringLinks<Real>& link, std::ptrdiff_t i) {
  const Real a = link.a[i], x = link.x[i], y = link.y[i], z = link.z[i];
  return {a + x * x, x * y, x * z, a + y * y, y * z, a + z * z};
}

template <class Real>
[[gnu::always_inline]] inline Block<Real> block_at(const Blocks<Real>& block, std::ptrdiff_t i) {
  return {block.xx[i], block.xy[i], block.xz[i], block.yy[i], block.yz[i], block.zz[i]};
}

template <class Real>
[[gnu::always_inline]] inline void store(const Blocks<Real>& blocks, std::ptrdiff_t i,
                                         const Block<Real>& block) {
  blocks.xx[i] = block.xx;
  blocks.xy[i] = block.xy;
  blocks.xz[i] = block.xz;
  blocks.yy[i] = block.yy;
  blocks.yz[i] = block.yz;
  blocks.zz[i] = block.zz;
}

/// A block's inverse is known to be at most 1 / `least` in each of its three directions. One whose trace is
/// more than this many times that is rounding's.
constexpr int kMostInverse = 12;

/// factor times the inverse of m, which is at least `least` times the identity, through L D L^T. Pivots
/// cannot be less than `least` but for rounding: held to it, the inverse stays positive definite. Where
/// rounding has left nothing of m, the inverse is `safe` times the identity, which no inverse is below.
template <class Real>
[[gnu::always_inline]] inline Block<Real> inverted(const Block<Real>& m, Real least, Real factor, Real safe) {
  const auto pivot = [least](Real d) WEFT_INLINE_LAMBDA { return 1 / (d > least ? d : least); };
  const Real d1 = pivot(m.xx);
  const Real l2 = m.xy * d1, l3 = m.xz * d1;
  const Real d2 = pivot(m.yy - l2 * m.xy);
  const Real l32 = (m.yz - l3 * m.xy) * d2;
  const Real d3 = pivot(m.zz - l3 * m.xz - l32 * (m.yz - l3 * m.xy));
  // The rows of L^-1, scaled: inverse = sum of d r r^T.
  const Real r31 = l32 * l2 - l3;
  const Real f1 = factor * d1, f2 = factor * d2, f3 = factor * d3;
  const Real xx = f1 + f2 * l2 * l2 + f3 * r31 * r31, yy = f2 + f3 * l32 * l32;
  const bool sound = least * (xx + yy + f3) <= Real(kMostInverse) * factor;
  const auto kept = [=](Real number, Real other) WEFT_INLINE_LAMBDA { return sound ? number : other; };
  const Real instead = factor * safe;
  return {kept(xx, instead),        kept(-f2 * l2 - f3 * r31 * l32, Real(0)),
          kept(f3 * r31, Real(0)),  kept(yy, instead),
          kept(-f3 * l32, Real(0)), kept(f3, instead)};
}

/// The diagonal block of node i: D and all links at it.
template <class Real, bool kBending, bool kBlocks, class Links>
[[gnu::always_inline]] inline Block<Real> node_block(const LinkMatrix<Real, Links>& matrix,
                                                     std::ptrdiff_t i) {
  const LinkFamilies<Links>& links = matrix.links;
  const std::ptrdiff_t stride = matrix.grid.stride;
  Block<Real> sum;
  sum.xx = sum.yy = sum.zz = matrix.diagonal[i];
  if constexpr (kBlocks) sum.add(block_at(matrix.blocks, i), Real(1));
  sum.add(block_at(links.along_u, i), Real(1));
  sum.add(block_at(links.along_u, i - 1), Real(1));
  sum.add(block_at(links.along_v, i), Real(1));
  sum.add(block_at(links.along_v, i - stride), Real(1));
  sum.add(block_at(links.falling, i), Real(1));
  sum.add(block_at(links.falling, i - stride - 1), Real(1));
  sum.add(block_at(links.rising, i), Real(1));
  sum.add(block_at(links.rising, i - stride + 1), Real(1));
  if constexpr (kBending) {
    sum.add(block_at(links.bending_u, i), Real(1));
    sum.add(block_at(links.bending_u, i - 2), Real(1));
    sum.add(block_at(links.bending_v, i), Real(1));
    sum.add(block_at(links.bending_v, i - 2 * stride), Real(1));
  }
  return sum;
}

}  // namespace weft::kernels
