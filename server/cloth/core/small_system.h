#pragma once
#include <Eigen/Core>

namespace weft {

// Eigen's decompositions but for inverses are compiled in small_system.cpp alone: each takes 10 s for each
// type of matrix.

/// n x n for n up to 6.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// The least x that comes nearest to a x = b, by a complete orthogonal decomposition (Golub, Van Loan: Matrix
/// Computations, 5.5): `a` may be singular, as the inertia is of nodes in one line.
SmallVector least_solution(const SmallMatrix& a, const SmallVector& b);

/// Of a symmetric matrix: eigenvalues, ascending, and for each a column of length 1.
struct SmallSpectrum {
  SmallVector values;
  SmallMatrix vectors;
};
SmallSpectrum spectrum_of(const SmallMatrix& symmetric);

}  // namespace weft
