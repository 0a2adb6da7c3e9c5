#pragma once
#include "cloth/kernels/link_kernels.h"
#include "cloth/kernels/spring_energy_kernels.h"
#include "cloth/kernels/xpbd_kernels.h"

/// The springs' kernels where springs may be cut: they read each row's own stiffnesses. Called only for
/// sheets that are torn; where springs have limits besides, limited_kernels.h has them.
namespace weft::kernels {

/// As add_spring_forces.
template <class Real>
void add_torn_spring_forces(const SpringLattice<Real>& springs, const Grid& grid,
                            Components<const Real> position, Components<Real> force, Real* work);

/// As linearise_springs.
template <class Real>
void linearise_torn_springs(const SpringLattice<Real>& springs, const Grid& grid,
                            Components<const Real> position, Real axial,
                            const LinkFamilies<SpringLinks<Real>>& links, RowRange rows);

/// As spring_model_error.
template <class Real>
SpringModelError torn_spring_model_error(const SpringLattice<Real>& springs, const Grid& grid,
                                         Components<const Real> position, Components<const Real> change);

/// As add_strain_damping and add_growth_damping.
template <class Real>
void add_torn_strain_damping(const SpringLattice<Real>& springs, const Grid& grid,
                             Components<const Real> position, Components<const Real> change, Real factor,
                             Components<Real> force, Real* work);
template <class Real>
void add_torn_growth_damping(const SpringLattice<Real>& springs, const Grid& grid,
                             Components<const Real> position, Components<const Real> way, Real factor,
                             Components<Real> force, Real* work);

/// As project.
template <class Real>
void project_torn(const QuarterRows& layout, const XpbdSprings<Real>& springs, Real* sheet);

}  // namespace weft::kernels
