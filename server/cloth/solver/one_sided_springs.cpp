#include "cloth/solver/one_sided_springs.h"

namespace weft {
namespace {

/// A share is found this finely.
constexpr double kStep = 1.0 / 1024;

/// Of the energy, which is convex, along the change.
double slope(const std::vector<OneSidedSpring>& springs, double decrease, double share) {
  double sum = -2 * decrease * (1 - share);
  for (const OneSidedSpring& spring : springs) {
    const double depth = spring.depth + share * spring.approach;
    if (spring.acts == (depth > 0)) continue;
    sum += (spring.acts ? -1 : 1) * spring.stiffness * depth * spring.approach;
  }
  return sum;
}

}  // namespace

double best_share(const std::vector<OneSidedSpring>& springs, double decrease) {
  if (slope(springs, decrease, 1) <= 0) return 1;
  double low = 0, high = 1;
  while (high - low > kStep) {
    const double middle = (low + high) / 2;
    (slope(springs, decrease, middle) > 0 ? high : low) = middle;
  }
  return high;
}

}  // namespace weft
