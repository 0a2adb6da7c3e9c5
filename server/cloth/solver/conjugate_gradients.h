#pragma once
#include "cloth/solver/multigrid.h"

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

/// Conjugate gradients on Multigrid's system (Shewchuk, An Introduction to the Conjugate Gradient Method,
/// 1994), preconditioned by its cycle. Keeps its vectors from one call to the next.
template <class Real>
class ConjugateGradients {
 public:
  explicit ConjugateGradients(const Grid& grid) : bands_(grid), vectors_(grid, 9) {}

  /// Improves x, the guess, until an iteration's progress in the squared energy norm x . A x, an estimate of
  /// the squared error before it (Hestenes and Stiefel 1952), is at most the target, or for
  /// `max_iterations`. What there was to find is the same estimate for no move at all. Wherever it stops, x .
  /// A x / 2 - b . x is not above 0, its value for no move at all: an implicit step so left unfinished loses
  /// energy and gains none. `b` and `x` lie in arrays with margins and are 0 at fixed nodes.
  LinearSolveReport solve(Multigrid<Real>& system, kernels::Components<const Real> b,
                          kernels::Components<Real> x, const SolveTarget& target, int max_iterations);

 private:
  Bands bands_;
  NodeArrays<Real> vectors_;
};

extern template class ConjugateGradients<float>;
extern template class ConjugateGradients<double>;

}  // namespace weft
