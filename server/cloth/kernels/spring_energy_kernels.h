#pragma once
#include "cloth/kernels/spring_kernels.h"

namespace weft::kernels {

/// Of all springs, J, those beyond their limits (limited_kernels.h) and the cut ones as they are.
template <class Real>
double spring_energy(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position);

/// How far the springs' energy after a change of the positions is from what their linearisation promised, J.
struct SpringModelError {
  double sum = 0;        ///< energy less promise: above 0, the springs resist more than was reckoned
  double magnitude = 0;  ///< the same without its sign, added up spring by spring
  double largest = 0;    ///< of that, in one spring
  /// The farthest that one is then past a limit (limited_kernels.h) that it was short of before, as a share
  /// of its length at rest: what the linearisation knew nothing of. 0 of springs without limits.
  double struck = 0;
};

/// Each spring's energy 1/2 k (l - l0)^2 at position + change, less its second-order model at `position` with
/// implicit_kernels.h's stiffness: what a turn of the spring adds. Both fields have their rows of zeros
/// (link_kernels.h).
template <class Real>
SpringModelError spring_model_error(const SpringLattice<Real>& springs, const Grid& grid,
                                    Components<const Real> position, Components<const Real> change);

}  // namespace weft::kernels
