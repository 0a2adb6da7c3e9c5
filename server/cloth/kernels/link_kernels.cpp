#include "cloth/kernels/link_kernels.h"

#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/node_blocks.h"

namespace weft::kernels {
namespace {

/// Calls finish(i, A x at node i, not yet masked).
template <class Real, bool kBending, bool kBlocks, class Links, class Finish>
[[gnu::always_inline]] inline void for_each_product(const LinkMatrix<Real, Links>& matrix,
                                                    const Components<const Real>& x, RowRange rows,
                                                    Real* work, Finish finish) {
  const Real* __restrict diagonal = matrix.diagonal;
  for_each_link_force<Real, kBending>(
      matrix.links, matrix.grid, x, rows, work,
      [&](std::ptrdiff_t i, const Triple<Real>& force) WEFT_INLINE_LAMBDA {
        const Real px = x.x[i], py = x.y[i], pz = x.z[i];
        Triple<Real> product{force.x + diagonal[i] * px, force.y + diagonal[i] * py,
                             force.z + diagonal[i] * pz};
        if constexpr (kBlocks) {
          const Triple<Real> rest = force_of(matrix.blocks, i, px, py, pz);
          product = {product.x + rest.x, product.y + rest.y, product.z + rest.z};
        }
        finish(i, product);
      });
}

template <class Real, class Links, class Finish>
[[gnu::always_inline]] inline void for_each_product(const LinkMatrix<Real, Links>& matrix,
                                                    const Components<const Real>& x, RowRange rows,
                                                    Real* work, Finish finish) {
  if constexpr (std::is_same_v<Links, Blocks<Real>>) {
    if (matrix.has_blocks) {
      for_each_product<Real, false, true>(matrix, x, rows, work, finish);
    } else {
      for_each_product<Real, false, false>(matrix, x, rows, work, finish);
    }
  } else if (matrix.links.has_bending) {
    if (matrix.has_blocks) {
      for_each_product<Real, true, true>(matrix, x, rows, work, finish);
    } else {
      for_each_product<Real, true, false>(matrix, x, rows, work, finish);
    }
  } else if (matrix.has_blocks) {
    for_each_product<Real, false, true>(matrix, x, rows, work, finish);
  } else {
    for_each_product<Real, false, false>(matrix, x, rows, work, finish);
  }
}

template <class Real, class Links>
[[gnu::always_inline]] inline double multiply_any(const LinkMatrix<Real, Links>& matrix,
                                                  Components<const Real> x, Components<Real> y, RowRange rows,
                                                  Real* work) {
  for_each_product(matrix, x, rows, work,
                   [&](std::ptrdiff_t i, const Triple<Real>& product) WEFT_INLINE_LAMBDA {
                     const Real free = matrix.free[i];
                     y.x[i] = free * product.x;
                     y.y[i] = free * product.y;
                     y.z[i] = free * product.z;
                   });
  return dot_rows<Real>(matrix.grid, x, y, rows);
}

template <class Real, class Links>
[[gnu::always_inline]] inline void residual_any(const LinkMatrix<Real, Links>& matrix,
                                                Components<const Real> x, Components<const Real> b,
                                                Components<Real> r, RowRange rows, Real* work) {
  for_each_product(matrix, x, rows, work,
                   [&](std::ptrdiff_t i, const Triple<Real>& product) WEFT_INLINE_LAMBDA {
                     const Real free = matrix.free[i];
                     r.x[i] = free * (b.x[i] - product.x);
                     r.y[i] = free * (b.y[i] - product.y);
                     r.z[i] = free * (b.z[i] - product.z);
                   });
}

template <class Real, class Links>
[[gnu::always_inline]] inline double relax_any(const LinkMatrix<Real, Links>& matrix,
                                               const Blocks<Real>& inverse, Components<const Real> x,
                                               Components<const Real> b, Components<Real> out, RowRange rows,
                                               Real* work) {
  for_each_product(matrix, x, rows, work,
                   [&](std::ptrdiff_t i, const Triple<Real>& product) WEFT_INLINE_LAMBDA {
                     const Triple<Real> change =
                         force_of(inverse, i, b.x[i] - product.x, b.y[i] - product.y, b.z[i] - product.z);
                     out.x[i] = x.x[i] + change.x;
                     out.y[i] = x.y[i] + change.y;
                     out.z[i] = x.z[i] + change.z;
                   });
  return dot_rows<Real>(matrix.grid, b, out, rows);
}

template <class Real, bool kBending, bool kBlocks, class Links>
[[gnu::always_inline]] inline void invert_rows(const LinkMatrix<Real, Links>& matrix, Real damping,
                                               const Blocks<Real>& inverse, RowRange rows) {
  const Grid& grid = matrix.grid;
  const std::ptrdiff_t stride = grid.stride;
  for (int r = rows.begin; r < rows.end; ++r) {
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < grid.cols; ++c) {
      const std::ptrdiff_t i = r * stride + c;
      const Block<Real> sum = node_block<Real, kBending, kBlocks>(matrix, i);
      store(inverse, i,
            inverted(sum, matrix.diagonal[i], damping * matrix.free[i], 1 / (sum.xx + sum.yy + sum.zz)));
    }
  }
}

template <class Real, class Links>
[[gnu::always_inline]] inline void invert_any(const LinkMatrix<Real, Links>& matrix, Real damping,
                                              const Blocks<Real>& inverse, RowRange rows) {
  const bool bending = matrix.links.has_bending;
  if (bending && matrix.has_blocks) {
    invert_rows<Real, true, true>(matrix, damping, inverse, rows);
  } else if (bending) {
    invert_rows<Real, true, false>(matrix, damping, inverse, rows);
  } else if (matrix.has_blocks) {
    invert_rows<Real, false, true>(matrix, damping, inverse, rows);
  } else {
    invert_rows<Real, false, false>(matrix, damping, inverse, rows);
  }
}

/// Sum over the five rows or columns beside a link and its own, weighted 1/4, 1/2, 1/4 of `weight`... across
/// it.
template <class Real, class Links>
[[gnu::always_inline]] inline void add_across(Block<Real>& sum, const Links& links, std::ptrdiff_t i,
                                              std::ptrdiff_t across, Real weight) {
  sum.add(block_at(links, i), weight);
  sum.add(block_at(links, i - across), weight / 2);
  sum.add(block_at(links, i + across), weight / 2);
}

/// A coarse structural link over the fine ones from node i on, `along` apart, and those beside them.
template <class Real, bool kBending, class Links>
[[gnu::always_inline]] inline Block<Real> coarse_structural(const Links& structural, const Links& bending,
                                                            std::ptrdiff_t i, std::ptrdiff_t along,
                                                            std::ptrdiff_t across) {
  Block<Real> sum;
  add_across(sum, structural, i, across, Real(0.25));
  add_across(sum, structural, i + along, across, Real(0.25));
  if constexpr (kBending) {
    // A bending link of stiffness k, twice as long as the fine cell, stretches like a structural one of 4 k.
    add_across(sum, bending, i, across, Real(1));
    add_across(sum, bending, i - along, across, Real(0.5));
    add_across(sum, bending, i + along, across, Real(0.5));
  }
  return sum;
}

/// Mean of the four fine diagonals that cross the coarse cell whose fine cells begin at node i.
template <class Real, class Links>
[[gnu::always_inline]] inline Block<Real> coarse_diagonal(const Links& links, std::ptrdiff_t i,
                                                          std::ptrdiff_t stride) {
  Block<Real> sum;
  for (const std::ptrdiff_t at : {i, i + 1, i + stride, i + stride + 1})
    sum.add(block_at(links, at), Real(0.25));
  return sum;
}

template <class Real, bool kBending, class Links>
[[gnu::always_inline]] inline void coarsen_rows(const Grid& fine_grid, const LinkFamilies<Links>& fine,
                                                const Grid& coarse_grid,
                                                const LinkFamilies<Blocks<Real>>& coarse, RowRange rows) {
  const std::ptrdiff_t stride = fine_grid.stride, coarse_stride = coarse_grid.stride;
  for (int r = rows.begin; r < rows.end; ++r) {
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c + 1 < coarse_grid.cols; ++c) {
      const std::ptrdiff_t i = (r * stride + c) * 2;
      store(coarse.along_u, r * coarse_stride + c,
            coarse_structural<Real, kBending>(fine.along_u, fine.bending_u, i, std::ptrdiff_t{1}, stride));
    }
    if (r + 1 == coarse_grid.rows) break;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < coarse_grid.cols; ++c) {
      const std::ptrdiff_t i = (r * stride + c) * 2;
      store(coarse.along_v, r * coarse_stride + c,
            coarse_structural<Real, kBending>(fine.along_v, fine.bending_v, i, stride, std::ptrdiff_t{1}));
    }
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c + 1 < coarse_grid.cols; ++c) {
      const std::ptrdiff_t i = (r * stride + c) * 2;
      store(coarse.falling, r * coarse_stride + c, coarse_diagonal<Real>(fine.falling, i, stride));
      // A rising link begins at its cell's right: the fine ones at columns 1 and 2 of the coarse cell.
      store(coarse.rising, r * coarse_stride + c + 1, coarse_diagonal<Real>(fine.rising, i + 1, stride));
    }
  }
}

template <class Real, class Links>
[[gnu::always_inline]] inline void coarsen_any(const Grid& fine_grid, const LinkFamilies<Links>& fine,
                                               const Grid& coarse_grid,
                                               const LinkFamilies<Blocks<Real>>& coarse, RowRange rows) {
  if (fine.has_bending) {
    coarsen_rows<Real, true>(fine_grid, fine, coarse_grid, coarse, rows);
  } else {
    coarsen_rows<Real, false>(fine_grid, fine, coarse_grid, coarse, rows);
  }
}

}  // namespace

std::size_t link_work_size(const Grid& grid) {
  return 3 * std::size_t{WorkRows<float>::kVectors} * WorkRows<float>::row_size(grid);
}

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_LINK_KERNELS(Real, Links)                                                                       \
  template <>                                                                                                \
  WEFT_MULTIVERSION double multiply(const LinkMatrix<Real, Links>& matrix, Components<const Real> x,         \
                                    Components<Real> y, RowRange rows, Real* work) {                         \
    return multiply_any<Real, Links>(matrix, x, y, rows, work);                                              \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void residual(const LinkMatrix<Real, Links>& matrix, Components<const Real> x,           \
                                  Components<const Real> b, Components<Real> r, RowRange rows, Real* work) { \
    residual_any<Real, Links>(matrix, x, b, r, rows, work);                                                  \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION double relax(const LinkMatrix<Real, Links>& matrix, const Blocks<Real>& inverse,         \
                                 Components<const Real> x, Components<const Real> b, Components<Real> out,   \
                                 RowRange rows, Real* work) {                                                \
    return relax_any<Real, Links>(matrix, inverse, x, b, out, rows, work);                                   \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void invert_diagonal(const LinkMatrix<Real, Links>& matrix, Real damping,                \
                                         const Blocks<Real>& inverse, RowRange rows) {                       \
    invert_any<Real, Links>(matrix, damping, inverse, rows);                                                 \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void coarsen_links(const Grid& fine_grid, const LinkFamilies<Links>& fine,               \
                                       const Grid& coarse_grid, const LinkFamilies<Blocks<Real>>& coarse,    \
                                       RowRange rows) {                                                      \
    coarsen_any<Real, Links>(fine_grid, fine, coarse_grid, coarse, rows);                                    \
  }

WEFT_LINK_KERNELS(float, SpringLinks<float>)
WEFT_LINK_KERNELS(float, Blocks<float>)
WEFT_LINK_KERNELS(double, SpringLinks<double>)
WEFT_LINK_KERNELS(double, Blocks<double>)
#undef WEFT_LINK_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
