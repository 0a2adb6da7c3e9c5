#pragma once
#include "cloth/kernels/spring_kernels.h"

namespace weft::kernels {

/// Scalars of work space that add_strain_damping needs, and limited_kernels.h's add_limit_damping.
inline std::size_t strain_damping_work_size(const Grid& grid) {
  return 3 * static_cast<std::size_t>(grid.stride);
}

/// Adds what resists the rate of the springs' lengths to both their ends, N: on end i -factor k n (n .
/// (change_i - change_j)), n the spring's direction at `position`. Positions, changes and forces lie on
/// `grid`. Central and opposite: linear and angular momentum are kept.
template <class Real>
void add_strain_damping(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                        Components<const Real> change, Real factor, Components<Real> force, Real* work);

/// The same with what the springs have grown by since their ends began the `way` that led to `position`: on
/// end i -factor k (|d| - |d - way_i + way_j|) n. However far they turned on it, it takes energy.
template <class Real>
void add_growth_damping(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                        Components<const Real> way, Real factor, Components<Real> force, Real* work);

}  // namespace weft::kernels
