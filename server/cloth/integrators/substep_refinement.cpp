#include "cloth/integrators/substep_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/kernels/state_kernels.h"

namespace weft {
namespace {

/// Steps until fewer substeps follow more: a second at 60 Hz.
constexpr int kHold = 60;
constexpr int kMost = 4;
constexpr double kStretch = 0.05, kTooLate = 0.5;
/// The way of a node in a substep of a stretched sheet, and of what strikes it; of a spring's length.
constexpr double kWay = 0.5, kStroke = 0.1;

/// For a quantity that falls with the substeps to be so small.
int times(double quantity, double most) {
  return static_cast<int>(std::ceil(std::clamp(quantity / most, 1.0, double(kMost))));
}

bool is_structural(const SpringFamily& family) {  // those join neighbours
  return family.rows + std::abs(family.cols) == 1;
}

/// By how much more than its stiffness says substeps of h seconds stretch a spring, as a share of what that
/// says: k h^2 (1/m_i + 1/m_j), in the middle of the sheet, and at its border, where k and m are halved.
template <class Real>
double excess(const Particles<Real>& particles, const SpringFamily& family, double h) {
  const Grid& grid = particles.grid();
  return family.stiffness * h * h * 2 / double(particles.mass.at(grid.rows / 2, grid.cols / 2));
}

/// What the springs ask for that are stretched in a step that begins, the one before having had so many times
/// the substeps of h seconds.
template <class Real>
int asked_by_stretch(const Particles<Real>& particles, const Springs<Real>& springs, double h, int before) {
  const kernels::StateExtremes<Real> most = kernels::state_extremes(
      particles.grid(), kernels::components(particles.position), kernels::components(particles.velocity));
  const double way = h * std::sqrt(double(most.speed));
  int asked = 1;
  for (const SpringFamily& family : springs.families()) {
    if (!is_structural(family)) continue;
    const double length = std::sqrt(double(family.rows == 0 ? most.along_u : most.along_v));
    const double stretch = length / family.rest_length - 1;
    if (before > 1) {
      const double own = stretch / (1 + excess(particles, family, h / before));
      const double with_fewer = own * (1 + excess(particles, family, h / (before - 1)));
      if (own < kStretch && with_fewer > kStretch) asked = std::max(asked, before);
    }
    if (!(length > (1 + kStretch) * family.rest_length)) continue;
    if (length > (1 + kTooLate) * family.rest_length) return 1;
    asked = std::max(asked, times(way, kWay * family.rest_length));
  }
  return asked;
}

/// What bodies ask for that strike the cloth in the step.
template <class Real>
int asked_by_strokes(const Particles<Real>& particles, const Springs<Real>& springs, Contact<Real>& contact,
                     const std::vector<Solid>& solids, double h, double dt) {
  double fastest = 0;  // m/s, head on
  for (const Arrival& arrival : contact.foresee(particles, solids, {0, 1, dt})) {
    fastest = std::max(fastest, arrival.approach);
  }
  double shortest = std::numeric_limits<double>::infinity();
  for (const SpringFamily& family : springs.families()) {
    if (is_structural(family)) shortest = std::min(shortest, family.rest_length);
  }
  return times(h * fastest, kStroke * shortest);
}

}  // namespace

template <class Real>
int SubstepRefinement<Real>::begin_step(const Particles<Real>& particles, const Springs<Real>& springs,
                                        Contact<Real>* contact, const std::vector<Solid>& solids, double h,
                                        double dt) {
  int asked = 1;
  if (!springs.torn()) asked = asked_by_stretch(particles, springs, h, times_);  // what is cut is no stretch
  if (contact != nullptr) {
    asked = std::max(asked, asked_by_strokes(particles, springs, *contact, solids, h, dt));
  }
  if (asked >= times_) {
    times_ = asked;
    held_ = kHold;
  } else if (held_-- == 0) {
    --times_;
    held_ = kHold;
  }
  return times_;
}

template class SubstepRefinement<float>;
template class SubstepRefinement<double>;

}  // namespace weft
