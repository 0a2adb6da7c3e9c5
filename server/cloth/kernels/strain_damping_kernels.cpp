#include "cloth/kernels/strain_damping_kernels.h"

#include "cloth/kernels/strain_damping_rows.h"

namespace weft::kernels {

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_STRAIN_DAMPING_KERNELS(Real)                                                                   \
  template <>                                                                                               \
  WEFT_MULTIVERSION void add_strain_damping(const SpringLattice<Real>& springs, const Grid& grid,           \
                                            Components<const Real> position, Components<const Real> change, \
                                            Real factor, Components<Real> force, Real* work) {              \
    strain_damping_rows::add_all<Real, strain_damping_rows::Damped::rate, false>(                           \
        springs, grid, factor, {position, change, force, strain_damping_rows::work_row(grid, work)});       \
  }                                                                                                         \
  template <>                                                                                               \
  WEFT_MULTIVERSION void add_growth_damping(const SpringLattice<Real>& springs, const Grid& grid,           \
                                            Components<const Real> position, Components<const Real> way,    \
                                            Real factor, Components<Real> force, Real* work) {              \
    strain_damping_rows::add_all<Real, strain_damping_rows::Damped::growth, false>(                         \
        springs, grid, factor, {position, way, force, strain_damping_rows::work_row(grid, work)});          \
  }

WEFT_STRAIN_DAMPING_KERNELS(float)
WEFT_STRAIN_DAMPING_KERNELS(double)
#undef WEFT_STRAIN_DAMPING_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
