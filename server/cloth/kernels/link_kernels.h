#pragma once
#include "cloth/kernels/components.h"

/// The linearised sheet, as the implicit methods solve with it: at every node a diagonal part, and between
/// neighbours `links`, springs that resist a difference d of their ends' displacements with a force linear in
/// d.
///
/// All arrays lie on one grid, with at least kMarginRows rows of zeros before and after it; the columns
/// beyond the grid's last hold zeros too. A link is stored at its first end; where there is none its numbers
/// are zero. So no loop asks whether a neighbour exists.
///
/// The templates exist for float and double, and for SpringLinks (the finest level) and Blocks (coarser
/// ones).
namespace weft::kernels {

inline constexpr int kMarginRows = 2;

/// What a spring along the unit vector n becomes: its force on d is a d + m (m . d), N, with m parallel to n.
template <class Real>
struct SpringLinks {
  Real *a, *x, *y, *z;
};

/// Symmetric 3 x 3 matrices: coarse links, or the nodes' diagonal blocks.
template <class Real>
struct Blocks {
  Real *xx, *xy, *xz, *yy, *yz, *zz;
};

/// The same from scalar n on.
template <class Real>
Blocks<Real> operator+(const Blocks<Real>& b, std::size_t n) {
  return {b.xx + n, b.xy + n, b.xz + n, b.yy + n, b.yz + n, b.zz + n};
}

/// The six families of springs.h. Bending links reach the second neighbour; coarser grids have none.
template <class Links>
struct LinkFamilies {
  Links along_u, along_v, falling, rising, bending_u, bending_v;
  bool has_bending = false;
};

/// A x = free (D x + links(x)): symmetric, positive definite on the nodes with free = 1. At the others
/// (free = 0) x must be and stays 0.
template <class Real, class Links>
struct LinkMatrix {
  Grid grid;
  LinkFamilies<Links> links;
  const Real* diagonal = nullptr;  ///< scalar part of D
  Blocks<Real> blocks{};           ///< the rest of D
  bool has_blocks = false;         ///< false: D is its scalar part
  const Real* free = nullptr;      ///< 1 or 0
};

/// Rows [begin, end) of a grid.
struct RowRange {
  int begin, end;
};

/// Scalars of work space that multiply, residual and relax need.
std::size_t link_work_size(const Grid& grid);

/// y = A x on the rows; returns their part of x . y.
template <class Real, class Links>
double multiply(const LinkMatrix<Real, Links>& matrix, Components<const Real> x, Components<Real> y,
                RowRange rows, Real* work);

/// r = free (b - A x) on the rows.
template <class Real, class Links>
void residual(const LinkMatrix<Real, Links>& matrix, Components<const Real> x, Components<const Real> b,
              Components<Real> r, RowRange rows, Real* work);

/// One sweep of block Jacobi on the rows: out = x + inverse (b - A x); returns their part of b . out.
template <class Real, class Links>
double relax(const LinkMatrix<Real, Links>& matrix, const Blocks<Real>& inverse, Components<const Real> x,
             Components<const Real> b, Components<Real> out, RowRange rows, Real* work);

/// inverse = free damping (D + the links at the node)^-1 on the rows, as relax wants it.
template <class Real, class Links>
void invert_diagonal(const LinkMatrix<Real, Links>& matrix, Real damping, const Blocks<Real>& inverse,
                     RowRange rows);

/// The links of the next coarser grid, on its `rows`: means of fine links in series, summed over parallel
/// ones, so that a uniform sheet's links keep their value. Bending links join the structural ones they lie
/// along.
template <class Real, class Links>
void coarsen_links(const Grid& fine_grid, const LinkFamilies<Links>& fine, const Grid& coarse_grid,
                   const LinkFamilies<Blocks<Real>>& coarse, RowRange rows);

}  // namespace weft::kernels
