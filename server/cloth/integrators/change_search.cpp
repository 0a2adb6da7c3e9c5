#include "cloth/integrators/change_search.h"

#include <algorithm>
#include <limits>
#include <utility>

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
ChangeSearch<Real>::ChangeSearch(std::vector<ChangedPart<Real>> parts, const LayerContacts<Real>* layers)
    : parts_(std::move(parts)), layers_(layers) {
  for (const ChangedPart<Real>& part : parts_) stretched_to_twice_ += part.stretched_to_twice;
}

template <class Real>
ChangeReport ChangeSearch<Real>::take_whole(double decrease) {
  std::vector<OneSidedSpring> springs;
  std::vector<kernels::Components<const Real>> moves, changes;
  for (const ChangedPart<Real>& part : parts_) {
    if (!part.contacts.empty())
      part.contacts.append_springs(part.move, part.change, part.system.bodies(), springs);
    part.system.bodies().append_springs(springs);
    moves.push_back(part.move);
    changes.push_back(part.change);
  }
  if (layers_ != nullptr) layers_->append_springs(moves, changes, springs);
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
  for (const ChangedPart<Real>& part : parts_) {
    clear(part.change, part.system.grid().size());
    part.system.bodies().scale_changes(0);
  }
  return {.taken = false};
}

template <class Real>
ChangeReport ChangeSearch<Real>::judge(double decrease) const {
  kernels::SpringModelError error;
  for (const ChangedPart<Real>& part : parts_) {
    const kernels::SpringModelError of_part =
        part.forces.model_error(part.system.grid(), part.position, part.change);
    error.sum += of_part.sum;
    error.magnitude += of_part.magnitude;
    error.largest = std::max(error.largest, of_part.largest);
    error.struck = std::max(error.struck, of_part.struck);
  }
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
  for (const ChangedPart<Real>& part : parts_) {
    for (Real* component : {part.change.x, part.change.y, part.change.z}) {
      std::transform(component, component + part.system.grid().size(), component,
                     [by = static_cast<Real>(share)](Real x) { return by * x; });
    }
    part.system.bodies().scale_changes(share);
  }
}

template class ChangeSearch<float>;
template class ChangeSearch<double>;

}  // namespace weft
