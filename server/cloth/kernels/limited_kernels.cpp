#include "cloth/kernels/limited_kernels.h"

#include "cloth/kernels/linearise_rows.h"
#include "cloth/kernels/spring_energy_rows.h"
#include "cloth/kernels/spring_rows.h"
#include "cloth/kernels/strain_damping_rows.h"
#include "cloth/kernels/xpbd_rows.h"

namespace weft::kernels {

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_LIMITED_KERNELS(Real)                                                                          \
  template <>                                                                                               \
  WEFT_MULTIVERSION void add_limited_spring_forces(const SpringLattice<Real>& springs, const Grid& grid,    \
                                                   Components<const Real> position, Components<Real> force, \
                                                   Real* work) {                                            \
    spring_rows::add_all<Real, true>(springs, grid, position, force, work);                                 \
  }                                                                                                         \
  template <>                                                                                               \
  WEFT_MULTIVERSION void linearise_limited_springs(                                                         \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position, Real axial,    \
      const LinkFamilies<SpringLinks<Real>>& links, RowRange rows) {                                        \
    linearise_rows::linearise<Real, true, false>(springs, grid, position, axial, links, rows);              \
  }                                                                                                         \
  template <>                                                                                               \
  WEFT_MULTIVERSION SpringModelError limited_spring_model_error(                                            \
      const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,                \
      Components<const Real> change) {                                                                      \
    return spring_energy_rows::model_error<Real, true, false>(springs, grid, {position, change});           \
  }                                                                                                         \
  template <>                                                                                               \
  WEFT_MULTIVERSION void add_limit_damping(const SpringLattice<Real>& springs, const Grid& grid,            \
                                           Components<const Real> position, Components<const Real> change,  \
                                           Real factor, Components<Real> force, Real* work) {               \
    strain_damping_rows::add_all<Real, strain_damping_rows::Damped::rate_beyond_limits, false>(             \
        springs, grid, factor * springs.excess,                                                             \
        {position, change, force, strain_damping_rows::work_row(grid, work)});                              \
  }                                                                                                         \
  template <>                                                                                               \
  WEFT_MULTIVERSION void project_limited(const QuarterRows& layout, const XpbdSprings<Real>& springs,       \
                                         Real* sheet) {                                                     \
    xpbd_rows::project<Real, true, false>(layout, springs, sheet);                                          \
  }

WEFT_LIMITED_KERNELS(float)
WEFT_LIMITED_KERNELS(double)
#undef WEFT_LIMITED_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
