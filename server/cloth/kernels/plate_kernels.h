#pragma once
#include "cloth/kernels/link_kernels.h"

/// A plate on the grid (plate.h): sums of squares of second differences, K = sum of k a a^T over its
/// stencils, the same in the three components. All templates exist for float and double.
namespace weft::kernels {

/// Stiffnesses of a plate's stencils, N/m, one array of the grid each; 0 where there is no stencil.
template <class Real>
struct PlateStencils {
  const Real* u;      ///< a = (1, -2, 1) on a node, its left and its right neighbour
  const Real* v;      ///< the same with the neighbours above and below
  const Real* twist;  ///< a = (1, -1, -1, 1) on a node, the next in its row and the two below them
};

/// Scalars of work space that the kernels below need.
std::size_t plate_work_size(const Grid& grid);

/// y += free (K x) on the rows; returns their part of x . (what was added).
template <class Real>
double add_plate(const PlateStencils<Real>& plate, const Grid& grid, Components<const Real> x,
                 const Real* free, Components<Real> y, RowRange rows, Real* work);

/// y -= free (K x) on the rows.
template <class Real>
void subtract_plate(const PlateStencils<Real>& plate, const Grid& grid, Components<const Real> x,
                    const Real* free, Components<Real> y, RowRange rows, Real* work);

/// The plate's part of a sweep of block Jacobi (link_kernels.h's relax) on the rows: out -= inverse (K x);
/// returns their part of b . (what was added).
template <class Real>
double relax_plate(const PlateStencils<Real>& plate, const Grid& grid, const Blocks<Real>& inverse,
                   Components<const Real> x, Components<const Real> b, Components<Real> out, RowRange rows,
                   Real* work);

}  // namespace weft::kernels
