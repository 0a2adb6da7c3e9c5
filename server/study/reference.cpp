#include "study/reference.h"

#include <algorithm>

namespace weft::study {
namespace {

IntegratorDescription tight_bdf2(int substeps) {
  Bdf2Description bdf2;
  bdf2.substeps = substeps;
  bdf2.tolerance = 1e-6;
  bdf2.newton_iterations = 3;
  bdf2.linear_iterations = 500;
  bdf2.liveliness = 0;  // the formula's own error, which extrapolation counts on
  return bdf2;
}

/// fine + (fine - coarse) / 3, for whatever is compared later.
Trajectory extrapolated(const Trajectory& coarse, const Trajectory& fine) {
  const auto from = [](double at_coarse, double at_fine) { return at_fine + (at_fine - at_coarse) / 3; };
  Trajectory answer = fine;
  for (std::size_t f = 0; f < fine.frames.size(); ++f) {
    const Frame& less = coarse.frames[f];
    Frame& more = answer.frames[f];
    std::transform(less.positions.begin(), less.positions.end(), more.positions.begin(),
                   more.positions.begin(), from);
    more.centre += (more.centre - less.centre) / 3;
    for (double Frame::*const each : {&Frame::kinetic_energy, &Frame::potential_energy, &Frame::mean_strain,
                                      &Frame::max_strain, &Frame::max_compression}) {
      more.*each = from(less.*each, more.*each);
    }
  }
  return answer;
}

/// What a run of half the step will take: at most twice as long, as the last two runs had it.
double next_seconds(const std::vector<Rung>& rungs, double last) {
  if (rungs.empty() || rungs.back().seconds <= 0) return 2 * last;
  return last * std::clamp(last / rungs.back().seconds, 1.0, 2.0);
}

}  // namespace

double Reference::reduction() const {
  if (rungs.size() < 3 || rungs.back().doubling == 0) return 0;
  return rungs[rungs.size() - 2].doubling / rungs.back().doubling;
}

Reference find_reference(const SimulationDescription& description, int level, int frames, double target,
                         const Allowance& allowance, const std::function<void()>& watch) {
  constexpr int kFirstSubsteps = 2;
  constexpr int kMostSubsteps = 1024;
  Reference reference;
  reference.level = level;
  Trajectory coarser;
  const auto run = [&](int substeps, double disturbance) {
    SimulationDescription stepped = description;
    stepped.integrator = tight_bdf2(substeps);
    return simulate<double>(std::move(stepped), {level, frames, 1, disturbance}, [&](int) {
      watch();
      return true;
    });
  };
  for (int substeps = kFirstSubsteps; substeps <= kMostSubsteps; substeps *= 2) {
    const double begin = allowance.now();
    Trajectory finer = run(substeps, 0);
    Rung rung{substeps, allowance.now() - begin, 0, {}};
    const double next = next_seconds(reference.rungs, rung.seconds);
    if (!finer.complete) {  // coarse steps may go bad where finer ones do not
      if (next > allowance.left()) break;
      continue;
    }
    if (reference.rungs.empty()) {
      reference.answer = finer;
    } else {
      if (reference.rungs.size() == 1) {
        const Trajectory disturbed = run(substeps, kSingleRounding);
        if (disturbed.complete) reference.rounding = errors_of(disturbed, finer);
        reference.chaotic = reference.rounding.rms_position > kChaos;
      }
      Trajectory answer = reference.chaotic ? finer : extrapolated(coarser, finer);
      rung.doubling = errors_of(finer, coarser).rms_position;
      rung.change = errors_of(answer, reference.answer);
      reference.answer = std::move(answer);
    }
    reference.rungs.push_back(rung);
    coarser = std::move(finer);
    if (!reference.usable()) continue;
    const double moved = reference.chaotic ? rung.change.mean_shape : rung.change.rms_position;
    if (moved < target || next > allowance.left()) break;
  }
  return reference;
}

}  // namespace weft::study
