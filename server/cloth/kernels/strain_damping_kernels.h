#pragma once
#include "cloth/kernels/spring_kernels.h"

namespace weft::kernels {

/// Scalars of work space that add_strain_damping needs.
std::size_t strain_damping_work_size(const Grid& grid);

/// Adds what resists the rate of the springs' lengths to both their ends, N: on end i -factor k n (n .
/// (change_i - change_j)), n the spring's direction at `position`. Positions, changes and forces lie on
/// `grid`. Central and opposite: linear and angular momentum are kept.
void add_strain_damping(const SpringLattice<float>& springs, const Grid& grid,
                        Components<const float> position, Components<const float> change, float factor,
                        Components<float> force, float* work);
void add_strain_damping(const SpringLattice<double>& springs, const Grid& grid,
                        Components<const double> position, Components<const double> change, double factor,
                        Components<double> force, double* work);

/// The same with what the springs have grown by since their ends began the `way` that led to `position`: on
/// end i -factor k (|d| - |d - way_i + way_j|) n. However far they turned on it, it takes energy.
void add_growth_damping(const SpringLattice<float>& springs, const Grid& grid,
                        Components<const float> position, Components<const float> way, float factor,
                        Components<float> force, float* work);
void add_growth_damping(const SpringLattice<double>& springs, const Grid& grid,
                        Components<const double> position, Components<const double> way, double factor,
                        Components<double> force, double* work);

/// The same as the first of what structural and shear springs have beyond their limits alone: on end i
/// -factor (excess k) n (n . (change_i - change_j)) of those that are longer.
void add_limit_damping(const SpringLattice<float>& springs, const Grid& grid,
                       Components<const float> position, Components<const float> change, float factor,
                       Components<float> force, float* work);
void add_limit_damping(const SpringLattice<double>& springs, const Grid& grid,
                       Components<const double> position, Components<const double> change, double factor,
                       Components<double> force, double* work);

}  // namespace weft::kernels
