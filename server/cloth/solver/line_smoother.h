#pragma once
#include "cloth/kernels/bands.h"
#include "cloth/kernels/line_kernels.h"
#include "cloth/solver/node_arrays.h"

namespace weft {

/// Damped line Jacobi on the finest grid: a sweep solves along all warp threads and along all weft threads
/// and adds up the two. The errors that a sheet's springs leave to a smoother are bent threads that keep
/// their length: stiffness acts along the thread only, whose direction turns from node to node. A smoother
/// that goes node by node cannot move them; a line solve passes the tension along all of the thread.
///
/// Symmetric, and as A <= 2 L in both directions (line_kernels.h) each sweep lowers the error in the energy
/// norm.
template <class Real>
class LineSmoother {
 public:
  using Matrix = kernels::LinkMatrix<Real, kernels::SpringLinks<Real>>;
  explicit LineSmoother(const Grid& grid);

  /// Takes up the matrix's numbers.
  void factorise(const Matrix& matrix);
  /// x = one sweep from zero.
  void start(const Matrix& matrix, kernels::Components<const Real> b, kernels::Components<Real> x);
  struct Sweep {
    kernels::Components<const Real> r;  ///< what x leaves of b
    kernels::Components<Real> x;
    kernels::Components<const Real> b;
    kernels::Components<Real> z;
  };
  /// z = x + one sweep; returns b . z. x is used up.
  double finish(const Matrix& matrix, const Sweep& sweep);

 private:
  /// Calls work(part) for [0, parts).
  template <class Work>
  void for_each_part(int parts, const Work& work) const;
  /// Calls work(columns, band) or work(first row, group) for all of them.
  template <class Work>
  void for_each_column_band(const Work& work) const;
  template <class Work>
  void for_each_group(const Work& work) const;
  kernels::LineFactors<Real> warp_factors() { return {warp_.blocks(), warp_.vector(6)}; }
  /// A direction's part of a sweep.
  void add_warp(const Matrix& matrix, const kernels::WarpSolve<Real>& fields);
  double add_weft(const kernels::WeftSolve<Real>& fields);
  Real* work(int part) { return work_.data() + static_cast<std::size_t>(part) * work_size_; }
  Real* weft(int group) { return weft_.data() + static_cast<std::size_t>(group) * weft_size_; }

  Grid grid_;
  int column_bands_;
  bool alone_;  ///< too small for help to pay
  int groups_;
  NodeArrays<Real> nodes_, warp_;
  std::size_t work_size_, weft_size_;  ///< scalars
  std::vector<Real, AlignedAllocator<Real>> weft_, work_;
  std::vector<double> products_;  ///< of each group
};

extern template class LineSmoother<float>;
extern template class LineSmoother<double>;

}  // namespace weft
