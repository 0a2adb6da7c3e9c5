#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// Springs from the nodes of a row to a neighbour, one kind in one direction.
template <class Real>
struct SpringColumns {
  const Real* stiffness =
      nullptr;            ///< N/m by column of the first end, one row of the grid; 0 where there is no spring
  Real rest_length = 0;   ///< m
  Real limit_length = 0;  ///< m, beyond which the limited kernels have it stiffer; not of bending springs
};

/// All springs of a sheet, as add_spring_forces reads them.
template <class Real>
struct SpringLattice {
  SpringColumns<Real> along_u, along_v;      ///< structural: to the next column, to the next row
  SpringColumns<Real> falling, rising;       ///< shear: to the next row's next column, to its previous one
  SpringColumns<Real> bending_u, bending_v;  ///< to the second column, to the second row
  Real border_row_share = 1;  ///< of the stiffness, for springs that lie in the first or last row
  bool has_shear = false, has_bending = false;
  Real excess = 0;  ///< beyond their limits springs are stiffer by so many times their stiffness
  /// From the stiffnesses of one row's springs to those of the next, for the torn kernels; the others take
  /// all rows to be alike, whatever it says.
  std::ptrdiff_t row_step = 0;
};

/// The lattice with the stiffnesses of row `r`'s springs.
template <class Real>
SpringLattice<Real> lattice_of_row(SpringLattice<Real> springs, int r) {
  for (SpringColumns<Real>* family : {&springs.along_u, &springs.along_v, &springs.falling, &springs.rising,
                                      &springs.bending_u, &springs.bending_v}) {
    family->stiffness += r * springs.row_step;
  }
  return springs;
}
/// The same for kernels where springs may be cut; the lattice itself in the others.
template <bool kTorn, class Real>
decltype(auto) springs_of_row(const SpringLattice<Real>& springs, int r) {
  if constexpr (kTorn) {
    return lattice_of_row(springs, r);
  } else {
    return (springs);
  }
}

/// Scalars of work space that add_spring_forces needs; all zero before the first call, the kernel keeps what
/// must stay so.
std::size_t spring_work_size(const Grid& grid);

/// Adds Eq. 1's force of every spring to both its ends, N. Positions and forces lie on `grid`.
template <class Real>
void add_spring_forces(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                       Components<Real> force, Real* work);

}  // namespace weft::kernels
