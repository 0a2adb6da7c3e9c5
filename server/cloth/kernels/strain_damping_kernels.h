#pragma once
#include "cloth/kernels/spring_kernels.h"

namespace weft::kernels {

/// Scalars of work space that add_strain_damping needs.
std::size_t strain_damping_work_size(const Grid& grid);

/// Adds what resists the rate of the springs' lengths to both their ends, N: on end i -factor k n (n .
/// (change_i - change_j)), n the spring's direction at `position`. Positions, changes and forces lie on
/// `grid`. Central and opposite: linear and angular momentum are kept.
template <class Real>
void add_strain_damping(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                        Components<const Real> change, Real factor, Components<Real> force, Real* work);
/// The same where springs may be cut.
template <class Real>
void add_torn_strain_damping(const SpringLattice<Real>& springs, const Grid& grid,
                             Components<const Real> position, Components<const Real> change, Real factor,
                             Components<Real> force, Real* work);

/// The same of what structural and shear springs have beyond their limits alone: on end i
/// -factor (excess k) n (n . (change_i - change_j)) of those that are longer.
template <class Real>
void add_limit_damping(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                       Components<const Real> change, Real factor, Components<Real> force, Real* work);
/// The same where springs may be cut.
template <class Real>
void add_torn_limit_damping(const SpringLattice<Real>& springs, const Grid& grid,
                            Components<const Real> position, Components<const Real> change, Real factor,
                            Components<Real> force, Real* work);

}  // namespace weft::kernels
