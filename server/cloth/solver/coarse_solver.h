#pragma once
#include <memory>

#include "cloth/kernels/link_kernels.h"
#include "cloth/sheet/plate.h"
#include "cloth/sheet/seam.h"

namespace weft {

/// Direct solution on the coarsest grid: Eigen's sparse Cholesky factors, in double. Seen by the multigrid
/// only.
template <class Real>
class CoarseSolver {
 public:
  using Matrix = kernels::LinkMatrix<Real, kernels::Blocks<Real>>;

  /// With `seam`, or nullptr: the nodes of its pairs are one unknown, pulled at by both's b.
  CoarseSolver(const Grid& grid, const Seam<Real>* seam);
  ~CoarseSolver();
  CoarseSolver(CoarseSolver&&) noexcept;
  CoarseSolver& operator=(CoarseSolver&&) noexcept;

  /// Takes up the matrix's numbers, and the plate's if there is one: always or never.
  void factorise(const Matrix& matrix, const Plate<Real>* plate);
  /// x = A^-1 b on the free nodes, 0 on the others.
  void solve(kernels::Components<const Real> b, kernels::Components<Real> x);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class CoarseSolver<float>;
extern template class CoarseSolver<double>;

}  // namespace weft
