#include "cloth/integrators/strong_air.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// The air's damping rate times a part's length, at most.
constexpr double kTakenAlong = 4;
constexpr double kMostPartsInAir = 64;

}  // namespace

template <class Real>
int parts_in_strong_air(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  if (!forces.any_slow()) return 1;
  const double rate = forces.max_damping_rates(particles).slow;
  return static_cast<int>(std::ceil(std::clamp(h * rate / kTakenAlong, 1.0, kMostPartsInAir)));
}

template int parts_in_strong_air(const Particles<float>&, const Forces<float>&, double);
template int parts_in_strong_air(const Particles<double>&, const Forces<double>&, double);

}  // namespace weft
