#include "cloth/integrators/substep_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/kernels/state_kernels.h"

namespace weft {
namespace {

/// Until fewer substeps follow more, s.
constexpr double kHold = 1;
constexpr int kMost = 4;
constexpr double kStretch = 0.05, kTooLate = 0.5;
/// The way of a node in a substep, of a spring's length: in a stretched sheet, against what yields to it, and
/// against what stands firm.
constexpr double kWay = 0.5, kStroke = 0.1, kFirmStroke = 0.15;

/// For a quantity that falls with the substeps to be so small.
int times(double quantity, double most) {
  return static_cast<int>(std::ceil(std::clamp(quantity / most, 1.0, double(kMost))));
}

bool is_structural(const SpringFamily& family) {  // those join neighbours
  return family.rows + std::abs(family.cols) == 1;
}

/// What substeps of h seconds stretch a spring by beyond what its stiffness says, m/N: h^2 (1/m_i + 1/m_j),
/// in the middle of the sheet. At its border, where the stiffness is halved, so is the mass.
template <class Real>
double yielding(const Particles<Real>& particles, double h) {
  const Grid& grid = particles.grid();
  return h * h * 2 / double(particles.mass.at(grid.rows / 2, grid.cols / 2));
}

/// The same as a share of what its stiffness says.
template <class Real>
double excess(const Particles<Real>& particles, const SpringFamily& family, double h) {
  return family.stiffness * yielding(particles, h);
}

/// What the springs ask for that are stretched in a step that begins, the one before having had so many times
/// the substeps of h seconds.
template <class Real>
int asked_by_stretch(const Particles<Real>& particles, const kernels::StateExtremes<Real>& most,
                     const Springs<Real>& springs, double h, int before) {
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

/// What asks for it that the sheet has to hold, a pressure or a hand's pull.
template <class Real>
int asked_by_tension(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const double needed = forces.tension(particles);
  if (needed == 0) return 1;
  int asked = 1;
  for (const SpringFamily& family : forces.sheet->springs().families()) {
    if (!is_structural(family)) continue;
    const double most = 1 / needed - 1 / family.stiffness;  // m/N; 0 or less where it bursts anyhow
    asked = std::max(asked, most > 0 ? times(std::sqrt(yielding(particles, h) / most), 1) : kMost);
  }
  return asked;
}

/// No point of it moves farther in the step, m.
double farthest(const Solid& solid) {
  return (solid.position - solid.start).norm() + solid.turn.norm() * outer_radius(solid.shape);
}

/// What solids ask for that strike the cloth, or that it strikes, in the step, its nodes having this `speed`
/// at most, m/s.
template <class Real>
int asked_by_strokes(const Particles<Real>& particles, double speed, const Springs<Real>& springs,
                     Contact<Real>& contact, const std::vector<Solid>& solids, double h, double dt) {
  double shortest = std::numeric_limits<double>::infinity();  // of springs that substeps soften
  for (const SpringFamily& family : springs.families()) {
    if (is_structural(family) && excess(particles, family, h) > kStretch)
      shortest = std::min(shortest, family.rest_length);
  }
  if (!std::isfinite(shortest)) return 1;
  double fastest = 0;  // m/s, of a solid
  for (const Solid& solid : solids) {
    if (solid.has_an_end()) fastest = std::max(fastest, farthest(solid) / dt);
  }
  if (h * (speed + fastest) <= kStroke * shortest) return 1;  // spares what is slow the search
  int asked = 1;
  const auto has_an_end = [](const Solid& solid) { return solid.has_an_end(); };
  for (const Arrival& arrival : contact.foresee(particles, solids, {0, 1, dt}, has_an_end)) {
    const double most = solids[arrival.solid].yields() ? kStroke : kFirmStroke;
    asked = std::max(asked, times(h * arrival.approach, most * shortest));
  }
  return asked;
}

}  // namespace

template <class Real>
int SubstepRefinement<Real>::begin_step(const Particles<Real>& particles, const Forces<Real>& forces,
                                        Contact<Real>* contact, const std::vector<Solid>& solids, double h,
                                        double dt) {
  const Springs<Real>& springs = forces.sheet->springs();
  const kernels::StateExtremes<Real> most = kernels::state_extremes(
      particles.grid(), kernels::components(particles.position), kernels::components(particles.velocity));
  int asked = asked_by_tension(particles, forces, h);
  if (!springs.torn()) {  // what is cut is no stretch
    asked = std::max(asked, asked_by_stretch(particles, most, springs, h, times_));
  }
  if (contact != nullptr) {
    asked = std::max(
        asked, asked_by_strokes(particles, std::sqrt(double(most.speed)), springs, *contact, solids, h, dt));
  }
  if (asked >= times_) {
    times_ = asked;
    held_ = kHold;
  } else if ((held_ -= dt) < -dt / 2) {
    --times_;
    held_ = kHold;
  }
  return times_;
}

template class SubstepRefinement<float>;
template class SubstepRefinement<double>;

}  // namespace weft
