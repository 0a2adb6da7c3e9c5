#include "cloth/kernels/spring_energy_kernels.h"

#include "cloth/kernels/spring_energy_rows.h"

namespace weft::kernels {

// target_clones needs each function written out.
template <>
WEFT_MULTIVERSION double spring_energy(const SpringLattice<float>& springs, const Grid& grid,
                                       Components<const float> position) {
  return spring_energy_rows::energy<float>(springs, grid, position);
}
template <>
WEFT_MULTIVERSION double spring_energy(const SpringLattice<double>& springs, const Grid& grid,
                                       Components<const double> position) {
  return spring_energy_rows::energy<double>(springs, grid, position);
}
template <>
WEFT_MULTIVERSION SpringModelError spring_model_error(const SpringLattice<float>& springs, const Grid& grid,
                                                      Components<const float> position,
                                                      Components<const float> change) {
  return spring_energy_rows::model_error<float, false, false>(springs, grid, {position, change});
}
template <>
WEFT_MULTIVERSION SpringModelError spring_model_error(const SpringLattice<double>& springs, const Grid& grid,
                                                      Components<const double> position,
                                                      Components<const double> change) {
  return spring_energy_rows::model_error<double, false, false>(springs, grid, {position, change});
}

}  // namespace weft::kernels
