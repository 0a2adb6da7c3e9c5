#pragma once
#include "cloth/kernels/link_kernels.h"
#include "cloth/kernels/spring_energy_kernels.h"
#include "cloth/kernels/xpbd_kernels.h"

/// The springs' kernels where structural and shear springs have their limits (StrainLimitEffect); linked and
/// called only for such sheets. Those of sheets that are torn besides are in limited_torn_kernels.cpp.
namespace weft::kernels {

/// As add_spring_forces.
template <class Real>
void add_limited_spring_forces(const SpringLattice<Real>& springs, const Grid& grid,
                               Components<const Real> position, Components<Real> force, Real* work);
template <class Real>
void add_limited_torn_spring_forces(const SpringLattice<Real>& springs, const Grid& grid,
                                    Components<const Real> position, Components<Real> force, Real* work);

/// As linearise_springs: beyond their limits with the stiffness and the tension they have there.
template <class Real>
void linearise_limited_springs(const SpringLattice<Real>& springs, const Grid& grid,
                               Components<const Real> position, Real axial,
                               const LinkFamilies<SpringLinks<Real>>& links, RowRange rows);
template <class Real>
void linearise_limited_torn_springs(const SpringLattice<Real>& springs, const Grid& grid,
                                    Components<const Real> position, Real axial,
                                    const LinkFamilies<SpringLinks<Real>>& links, RowRange rows);

/// As spring_model_error, against linearise_limited_springs.
template <class Real>
SpringModelError limited_spring_model_error(const SpringLattice<Real>& springs, const Grid& grid,
                                            Components<const Real> position, Components<const Real> change);
template <class Real>
SpringModelError limited_torn_spring_model_error(const SpringLattice<Real>& springs, const Grid& grid,
                                                 Components<const Real> position,
                                                 Components<const Real> change);

/// As add_strain_damping, of what structural and shear springs have beyond their limits alone: on end i
/// -factor (excess k) n (n . (change_i - change_j)) of those that are longer.
template <class Real>
void add_limit_damping(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                       Components<const Real> change, Real factor, Components<Real> force, Real* work);
template <class Real>
void add_torn_limit_damping(const SpringLattice<Real>& springs, const Grid& grid,
                            Components<const Real> position, Components<const Real> change, Real factor,
                            Components<Real> force, Real* work);

/// As project, where springs stiffen. As its tension is the larger one of two straight lines in its length, a
/// spring's multiplier is the larger one of those that either of them gives: no branch.
template <class Real>
void project_limited(const QuarterRows& layout, const XpbdSprings<Real>& springs, Real* sheet);
template <class Real>
void project_limited_torn(const QuarterRows& layout, const XpbdSprings<Real>& springs, Real* sheet);

}  // namespace weft::kernels
