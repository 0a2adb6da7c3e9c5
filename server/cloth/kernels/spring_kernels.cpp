#include "cloth/kernels/spring_kernels.h"

#include "cloth/kernels/spring_rows.h"

namespace weft::kernels {

std::size_t spring_work_size(const Grid& grid) {
  return spring_rows::kWorkRows * spring_rows::work_row_size(grid);
}

// target_clones needs each function written out.
template <>
WEFT_MULTIVERSION void add_spring_forces(const SpringLattice<float>& springs, const Grid& grid,
                                         Components<const float> position, Components<float> force,
                                         float* work) {
  spring_rows::add_all<float, false>(springs, grid, position, force, work);
}

template <>
WEFT_MULTIVERSION void add_spring_forces(const SpringLattice<double>& springs, const Grid& grid,
                                         Components<const double> position, Components<double> force,
                                         double* work) {
  spring_rows::add_all<double, false>(springs, grid, position, force, work);
}

}  // namespace weft::kernels
