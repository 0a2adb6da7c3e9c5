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
LinearSolveReport ConjugateGradients<Real>::solve(std::span<const SystemPart<Real>> parts,
                                                  const SystemCouplings<Real>& couplings,
                                                  const SolveTarget& target, int max_iterations) {
  using Vectors = std::vector<kernels::Components<Real>>;  // one a part
  Vectors x, p, q, r;
  std::size_t nodes = 0;
  for (const SystemPart<Real>& part : parts) {
    NodeArrays<Real>& vectors = part.solver->vectors_;
    x.push_back(part.x);
    p.push_back(vectors.vector(0));
    q.push_back(vectors.vector(3));
    r.push_back(vectors.vector(6));
    nodes += part.system->grid().size();
  }
  const bool corrected = parts[0].correction != nullptr;
  const auto sum = [&](const auto& of_part) {
    double all = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) all += of_part(k, parts[k].system->grid());
    return all;
  };
  const auto for_each_stretch = [&](const auto& work) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k].solver->bands_.for_each_stretch(
          [&](std::size_t first, std::size_t count) { work(k, first, count); });
    }
  };
  const auto multiply = [&](const Vectors& from, const Vectors& to) {
    double product =
        sum([&](std::size_t k, const Grid&) { return parts[k].system->multiply(from[k], to[k]); });
    if (!couplings.empty()) product += couplings.multiply(from, to);
    return product;
  };
  const auto dot = [&](const Vectors& a, const Vectors& b) {
    return sum([&](std::size_t k, const Grid& grid) { return kernels::dot<Real>(a[k], b[k], grid); });
  };

  LinearSolveReport report;
  // The multiple of the guess that lies nearest in the energy norm: never farther than zero is.
  const double size = multiply(x, q);
  const double along =
      size > 0
          ? sum([&](std::size_t k, const Grid& grid) { return kernels::dot<Real>(parts[k].b, x[k], grid); })
          : 0.0;
  const double scale = size > 0 ? along / size : 0.0;
  report.decrease = scale * along / 2;
  if (corrected) {
    // The part of it that is A-orthogonal to the guess: then each has its own best multiple.
    const double shared = size > 0 ? sum([&](std::size_t k, const Grid& grid) {
                                       return kernels::dot<Real>(*parts[k].correction, q[k], grid);
                                     }) / size
                                   : 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const std::size_t count = parts[k].system->grid().size();
      copy<Real>(*parts[k].correction, p[k], count);
      kernels::add_scaled(p[k], x[k], static_cast<Real>(-shared), count);
    }
  }
  for_each_stretch([&](std::size_t k, std::size_t first, std::size_t count) {
    kernels::scale_guess<Real>(x[k] + first, parts[k].b + first, q[k] + first, r[k] + first,
                               static_cast<Real>(scale), count);
  });
  if (corrected) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      copy<Real>(x[k], *parts[k].correction, parts[k].system->grid().size());
    }
    const double curvature = multiply(p, q), found = dot(r, p);
    if (curvature > 0) {
      for (std::size_t k = 0; k < parts.size(); ++k) {
        kernels::advance_along<Real>(x[k], p[k], r[k], q[k], static_cast<Real>(found / curvature),
                                     parts[k].system->grid().size());
      }
      report.decrease += found * found / curvature / 2;
    }
  }
  // Rounding may make of the cycle what is not positive definite: then, for the rest of the solve, without
  // it.
  bool cycles = true;
  const auto precondition = [&](const Vectors& z) {
    if (cycles) {
      bool positive = true;
      const double found = sum([&](std::size_t k, const Grid&) {
        const double of_part = parts[k].system->precondition(r[k], z[k]);
        positive = positive && !(of_part < 0);
        return of_part;
      });
      if (positive && found > 0) return found;
      cycles = false;
    }
    for (std::size_t k = 0; k < parts.size(); ++k) copy<Real>(r[k], z[k], parts[k].system->grid().size());
    return dot(r, r);
  };
  double rz = precondition(p);
  report.target = std::max(target.least, std::min(target.share * (2 * report.decrease + rz), target.most));
  ErrorEstimate error;
  while (rz > 0 && report.iterations < max_iterations) {
    check_interrupt(kWorkOfCycle * static_cast<double>(nodes));
    const double curvature = multiply(p, q);
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    for_each_stretch([&](std::size_t k, std::size_t first, std::size_t count) {
      kernels::advance_along<Real>(x[k] + first, p[k] + first, r[k] + first, q[k] + first,
                                   static_cast<Real>(step), count);
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
    for_each_stretch([&](std::size_t k, std::size_t first, std::size_t count) {
      kernels::turn_towards<Real>(p[k] + first, q[k] + first, static_cast<Real>(turned), count);
    });
    rz = next;
  }
  report.converged = report.converged || rz == 0;
  report.finite = std::isfinite(rz);
  if (corrected) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      kernels::scaled_difference<Real>(x[k], *parts[k].correction, Real(1), *parts[k].correction,
                                       parts[k].system->grid().size());
    }
  }
  return report;
}

template class ConjugateGradients<float>;
template class ConjugateGradients<double>;

}  // namespace weft
