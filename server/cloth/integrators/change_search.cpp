#include "cloth/integrators/change_search.h"

#include <algorithm>
#include <limits>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// A whole change that adds so many times the energy that it was to remove, and strains all springs by
/// kWildStrain on average, is halved until it does not: the next linearisations would take long to return.
constexpr double kWild = 10, kWildStrain = 0.01;
/// Shortest share of a change that a search tries.
constexpr double kSmallestShare = 1e-4;
/// Rounding of energies that are summed and subtracted, in units of the scalar's last digit: less cannot be
/// told from a gain.
constexpr double kRounding = 4;
/// The same of what a solve gains: its directions gain and lose far more than their sum.
constexpr double kSolveRounding = 300;

}  // namespace

template <class Real>
ChangeReport ChangeSearch<Real>::take_whole(double decrease) {
  std::vector<OneSidedSpring> springs;
  if (!contacts_.empty()) contacts_.append_springs(nodes_.move, nodes_.change, system_.bodies(), springs);
  system_.bodies().append_springs(springs);
  if (forces_.layers != nullptr) forces_.layers->append_springs(nodes_.move, nodes_.change, springs);
  double share = springs.empty() ? 1 : best_share(springs, decrease);
  if (share < 1) scale(share);
  for (;;) {
    const double left_over = (1 - share) * (1 - share) * decrease;
    const ChangeReport report = judge(decrease - left_over);
    if (!report.wild || share < kSmallestShare)
      return {report.brought_in, std::max(report.error, left_over), report.largest, report.struck};
    scale(0.5);
    share /= 2;
  }
}

template <class Real>
ChangeReport ChangeSearch<Real>::take_searched(double decrease) {
  for (double share = 1; share > kSmallestShare; share /= 2) {
    // A share of the change has share (2 - share) of the decrease.
    const ChangeReport report = judge(share * (2 - share) * decrease);
    if (report.brought_in <= 0) return report;
    scale(0.5);
  }
  clear(nodes_.change, system_.grid().size());
  system_.bodies().scale_changes(0);
  return {.taken = false};
}

template <class Real>
ChangeReport ChangeSearch<Real>::judge(double decrease) const {
  const kernels::SpringModelError error = forces_.model_error(system_.grid(), nodes_.position, nodes_.change);
  const double rounding = double(std::numeric_limits<Real>::epsilon()) *
                          (kRounding * error.magnitude + kSolveRounding * decrease);
  return {.brought_in = error.sum - decrease + rounding,
          .error = error.magnitude,
          .largest = error.largest,
          .struck = error.struck,
          .wild = error.sum - decrease > kWild * decrease &&
                  error.sum > kWildStrain * kWildStrain * stretched_to_twice_ + rounding};
}

template <class Real>
void ChangeSearch<Real>::scale(double share) {
  for (Real* component : {nodes_.change.x, nodes_.change.y, nodes_.change.z}) {
    std::transform(component, component + system_.grid().size(), component,
                   [part = static_cast<Real>(share)](Real x) { return part * x; });
  }
  system_.bodies().scale_changes(share);
}

template class ChangeSearch<float>;
template class ChangeSearch<double>;

}  // namespace weft
