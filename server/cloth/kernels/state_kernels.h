#pragma once
#include "cloth/kernels/spring_kernels.h"

namespace weft::kernels {

/// The largest of a state, squared. NaN or infinite if a position or a velocity is, or if the square is
/// beyond Real.
template <class Real>
struct StateExtremes {
  Real speed = 0;    ///< m2/s2
  Real along_u = 0;  ///< distance of neighbours in a row, m2
  Real along_v = 0;  ///< of neighbours in a column, m2
};

StateExtremes<float> state_extremes(const Grid& grid, Components<const float> position,
                                    Components<const float> velocity);
StateExtremes<double> state_extremes(const Grid& grid, Components<const double> position,
                                     Components<const double> velocity);

/// The largest of the structural and shear springs that are there, as shares of their length at rest.
struct SpringMotion {
  double strain = 0;  ///< by how much one is longer or shorter
  double speed = 0;   ///< 1/s, of one end past the other, in any direction
};

SpringMotion spring_motion(const SpringLattice<float>& springs, const Grid& grid,
                           Components<const float> position, Components<const float> velocity);
SpringMotion spring_motion(const SpringLattice<double>& springs, const Grid& grid,
                           Components<const double> position, Components<const double> velocity);

}  // namespace weft::kernels
