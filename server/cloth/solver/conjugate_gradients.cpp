#include "cloth/solver/conjugate_gradients.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/core/interrupt.h"
#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// With its multigrid cycle, a node (WorkLimit).
constexpr double kWorkOfCycle = 4;

}  // namespace

void ErrorEstimate::add(double progress) {
  found_[2] = found_[1];
  found_[1] = found_[0];
  found_[0] = progress;
  ++count_;
}

double ErrorEstimate::squared() const {
  if (count_ < 2) return found_[0];
  const double last = found_[0] / found_[1];
  const double fall = count_ < 3 ? last : std::max(last, found_[1] / found_[2]);
  if (fall >= 1) return std::numeric_limits<double>::infinity();
  return found_[0] * std::max(1.0, fall / (1 - fall));
}

template <class Real>
LinearSolveReport ConjugateGradients<Real>::solve(Multigrid<Real>& system, kernels::Components<const Real> b,
                                                  kernels::Components<Real> x, const SolveTarget& target,
                                                  int max_iterations,
                                                  const kernels::Components<Real>* correction) {
  const Grid& grid = system.grid();
  kernels::Components<Real> p = vectors_.vector(0), q = vectors_.vector(3), r = vectors_.vector(6);
  LinearSolveReport report;
  // The multiple of the guess that lies nearest in the energy norm: never farther than zero is.
  const double size = system.multiply(x, q);
  const double along = size > 0 ? kernels::dot<Real>(b, x, grid) : 0.0;
  const double scale = size > 0 ? along / size : 0.0;
  report.decrease = scale * along / 2;
  if (correction != nullptr) {
    // The part of it that is A-orthogonal to the guess: then each has its own best multiple.
    const double shared = size > 0 ? kernels::dot<Real>(*correction, q, grid) / size : 0.0;
    copy<Real>(*correction, p, grid.size());
    kernels::add_scaled(p, x, static_cast<Real>(-shared), grid.size());
  }
  bands_.for_each_stretch([&](std::size_t first, std::size_t count) {
    kernels::scale_guess<Real>(x + first, b + first, q + first, r + first, static_cast<Real>(scale), count);
  });
  if (correction != nullptr) {
    copy<Real>(x, *correction, grid.size());
    const double curvature = system.multiply(p, q), found = kernels::dot<Real>(r, p, grid);
    if (curvature > 0) {
      kernels::advance_along<Real>(x, p, r, q, static_cast<Real>(found / curvature), grid.size());
      report.decrease += found * found / curvature / 2;
    }
  }
  // Rounding may make of the cycle what is not positive definite: then, for the rest of the solve, without
  // it.
  bool cycles = true;
  const auto precondition = [&](kernels::Components<Real> z) {
    if (cycles) {
      const double found = system.precondition(r, z);
      if (found > 0) return found;
      cycles = false;
    }
    copy<Real>(r, z, grid.size());
    return kernels::dot<Real>(r, r, grid);
  };
  double rz = precondition(p);
  report.target = std::max(target.least, std::min(target.share * (2 * report.decrease + rz), target.most));
  ErrorEstimate error;
  while (rz > 0 && report.iterations < max_iterations) {
    check_interrupt(kWorkOfCycle * static_cast<double>(grid.size()));
    const double curvature = system.multiply(p, q);
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    bands_.for_each_stretch([&](std::size_t first, std::size_t count) {
      kernels::advance_along<Real>(x + first, p + first, r + first, q + first, static_cast<Real>(step),
                                   count);
    });
    ++report.iterations;
    report.decrease += step * rz / 2;
    error.add(step * rz);
    if (error.squared() <= report.target) {
      report.converged = true;
      break;
    }
    const bool cycled = cycles;
    const double next = precondition(q);
    const double turned = cycled == cycles ? next / rz : 0;  // directions of the cycle are none without it
    bands_.for_each_stretch([&](std::size_t first, std::size_t count) {
      kernels::turn_towards<Real>(p + first, q + first, static_cast<Real>(turned), count);
    });
    rz = next;
  }
  report.converged = report.converged || rz == 0;
  report.finite = std::isfinite(rz);
  if (correction != nullptr) {
    kernels::scaled_difference<Real>(x, *correction, Real(1), *correction, grid.size());
  }
  return report;
}

template class ConjugateGradients<float>;
template class ConjugateGradients<double>;

}  // namespace weft
