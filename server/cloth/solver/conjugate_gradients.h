#pragma once
#include <span>

#include "cloth/solver/multigrid.h"
#include "cloth/solver/system_couplings.h"

namespace weft {

struct LinearSolveReport {
  int iterations = 0;
  bool converged = false;
  bool finite = true;   ///< the system was, as far as it was looked at
  double decrease = 0;  ///< of x . A x / 2 - b . x from x = 0, J; never below 0
  double target = 0;    ///< J, to which it was solved
};

/// When a solve may end: the squared error, J, is at most `share` of what there was to find, but held to
/// between `least` and `most`.
struct SolveTarget {
  double least = 0;
  double share = 0;
  double most = 0;
};

/// What conjugate gradients have still to find, by what the last iterations found: the squared errors before
/// them fall by the sums of what they found (Hestenes and Stiefel 1952), which is taken to go on falling as
/// it did from one to the next of the last three where it fell less (after Strakos and Tichy, On Error
/// Estimation in the Conjugate Gradient Method, 2002, who wait some iterations to know instead). What one
/// iteration finds is the error before it only where each leaves little to the next: with springs of 1e7 N/m
/// it was up to 30 times too small.
class ErrorEstimate {
 public:
  /// An iteration found `progress`, J: lowered the squared error by it.
  void add(double progress);
  /// The squared error, J: of before the last iteration where they find less and less fast, else what is left
  /// after it; infinite where they do not yet.
  double squared() const;

 private:
  double found_[3] = {};  ///< J, the last first
  int count_ = 0;
};

template <class Real>
class ConjugateGradients;

/// One cloth's part of a system that several are solved in together.
template <class Real>
struct SystemPart {
  ConjugateGradients<Real>* solver;
  Multigrid<Real>* system;
  kernels::Components<const Real> b;
  kernels::Components<Real> x;
  const kernels::Components<Real>* correction = nullptr;
};

/// Conjugate gradients on Multigrid's system, or several (Shewchuk, An Introduction to the Conjugate Gradient
/// Method, 1994), preconditioned by its cycle. Each system has one, which keeps its vectors from one call to
/// the next.
template <class Real>
class ConjugateGradients {
 public:
  explicit ConjugateGradients(const Grid& grid) : bands_(grid), vectors_(grid, 9) {}

  /// Of the parts, which `couplings` join to one system, improves all x, the guess, until the squared error,
  /// in the energy norm x . A x, is at most the target by ErrorEstimate, or for `max_iterations`. What there
  /// was to find is what the guess found and a first iteration would. Wherever it stops, x . A x / 2 - b . x
  /// is not above 0, its value for no move at all: an implicit step so left unfinished loses energy and gains
  /// none. `b` and `x` lie in arrays with margins and are 0 at fixed nodes.
  ///
  /// `correction`, of all parts or none, is such an array too: what an earlier solve of a system much like
  /// this one found beside its guess. This one begins with the best of the guess and the correction together,
  /// and leaves its own there.
  static LinearSolveReport solve(std::span<const SystemPart<Real>> parts,
                                 const SystemCouplings<Real>& couplings, const SolveTarget& target,
                                 int max_iterations);

 private:
  Bands bands_;
  NodeArrays<Real> vectors_;
};

extern template class ConjugateGradients<float>;
extern template class ConjugateGradients<double>;

}  // namespace weft
