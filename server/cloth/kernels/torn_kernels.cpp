#include "cloth/kernels/torn_kernels.h"

#include "cloth/kernels/linearise_rows.h"
#include "cloth/kernels/spring_energy_rows.h"
#include "cloth/kernels/spring_rows.h"
#include "cloth/kernels/strain_damping_rows.h"
#include "cloth/kernels/xpbd_rows.h"

namespace weft::kernels {

// Forces have one variant for all: springs that are not there have no stiffness.
// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_TORN_KERNELS(Real)                                                                          \
  template <>                                                                                            \
  WEFT_MULTIVERSION void add_torn_spring_forces(const SpringLattice<Real>& springs, const Grid& grid,    \
                                                Components<const Real> position, Components<Real> force, \
                                                Real* work) {                                            \
    spring_rows::add_all_rows<Real, true, true, false, true>(springs, grid, position, force, work);      \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void linearise_torn_springs(                                                         \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position, Real axial, \
      const LinkFamilies<SpringLinks<Real>>& links, RowRange rows) {                                     \
    linearise_rows::linearise<Real, false, true>(springs, grid, position, axial, links, rows);           \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION SpringModelError torn_spring_model_error(                                            \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,             \
      Components<const Real> change) {                                                                   \
    return spring_energy_rows::model_error<Real, false, true>(springs, grid, {position, change});        \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void add_torn_strain_damping(                                                        \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,             \
      Components<const Real> change, Real factor, Components<Real> force, Real* work) {                  \
    strain_damping_rows::add_all<Real, strain_damping_rows::Damped::rate, true>(                         \
        springs, grid, factor, {position, change, force, strain_damping_rows::work_row(grid, work)});    \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void add_torn_growth_damping(                                                        \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,             \
      Components<const Real> change, Real factor, Components<Real> force, Real* work) {                  \
    strain_damping_rows::add_all<Real, strain_damping_rows::Damped::growth, true>(                       \
        springs, grid, factor, {position, change, force, strain_damping_rows::work_row(grid, work)});    \
  }                                                                                                      \
  template <>                                                                                            \
  WEFT_MULTIVERSION void project_torn(const QuarterRows& layout, const XpbdSprings<Real>& springs,       \
                                      Real* sheet) {                                                     \
    xpbd_rows::project<Real, false, true>(layout, springs, sheet);                                       \
  }

WEFT_TORN_KERNELS(float)
WEFT_TORN_KERNELS(double)
#undef WEFT_TORN_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
