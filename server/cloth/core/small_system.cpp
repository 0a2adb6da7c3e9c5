#include "cloth/core/small_system.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace weft {

SmallVector least_solution(const SmallMatrix& a, const SmallVector& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

SmallSpectrum spectrum_of(const SmallMatrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace weft
