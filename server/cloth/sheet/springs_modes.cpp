/// The springs' stiffest mode: a bound on its frequency and damping.
#include <algorithm>

#include "cloth/sheet/springs.h"

namespace weft {
namespace {

/// Stiffness of each kind away from the border; a family that is absent has 0.
struct LatticeStiffness {
  double along_u = 0, along_v = 0, shear = 0, bending_u = 0, bending_v = 0;

  /// Within the springs' limits, or beyond them all.
  LatticeStiffness(const std::vector<SpringFamily>& families, bool stiffened) {
    for (const SpringFamily& family : families) {
      const double stiffness = family.stiffness * (stiffened ? family.limit.stiffening : 1);
      if (family.rows == 0) {
        (family.cols == 1 ? along_u : bending_u) = stiffness;
      } else if (family.cols == 0) {
        (family.rows == 1 ? along_v : bending_v) = stiffness;
      } else {
        shear = stiffness;  // both diagonals are alike
      }
    }
  }

  /// Sum of 2 k (1 - cos(theta . offset)) over the springs of an infinite lattice, a and b being the cosines
  /// of theta's two components: what a plane wave feels when every spring resists it with its full stiffness.
  double of_wave(double a, double b) const {
    return 2 * along_u * (1 - a) + 2 * along_v * (1 - b) + 4 * shear * (1 - a * b) +
           4 * bending_u * (1 - a * a) + 4 * bending_v * (1 - b * b);
  }

  /// Largest of_wave for a, b in [-1, 1]: on the square's corners, or where it is stationary on a side or
  /// inside.
  double of_stiffest_wave() const {
    const auto clamped = [](double numerator, double denominator) {
      return denominator > 0 ? std::clamp(numerator / denominator, -1.0, 1.0) : -1.0;
    };
    double most = 0;
    for (const double side : {-1.0, 1.0}) {
      most = std::max({most, of_wave(side, -1), of_wave(side, 1)});
      most = std::max(most, of_wave(side, clamped(-2 * along_v - 4 * shear * side, 8 * bending_v)));
      most = std::max(most, of_wave(clamped(-2 * along_u - 4 * shear * side, 8 * bending_u), side));
    }
    const double determinant = 64 * bending_u * bending_v - 16 * shear * shear;
    if (determinant > 0) {
      const double a = clamped(-16 * bending_v * along_u + 8 * shear * along_v, determinant);
      const double b = clamped(-16 * bending_u * along_v + 8 * shear * along_u, determinant);
      most = std::max(most, of_wave(a, b));
    }
    return most;
  }
};

}  // namespace

template <class Real>
double Springs<Real>::max_squared_frequency(const Field<Real>& mass) const {
  return squared_frequency(mass, true);
}

template <class Real>
double Springs<Real>::max_damping_rate(const Field<Real>& mass) const {
  return damping_time_ == 0 ? 0 : damping_time_ * squared_frequency(mass, false);
}

template <class Real>
double Springs<Real>::squared_frequency(const Field<Real>& mass, bool stiffened) const {
  if (families_.empty()) return 0;
  // A spring's stiffness matrix is at most k I, so K is at most the lattice's weighted Laplacian, for any
  // shape. With border springs at full stiffness the sheet is part of an infinite lattice: K <= S I, S that
  // of the stiffest wave. At half stiffness the sheet mirrored at its borders is a periodic lattice in which
  // a border node counts half, a corner a quarter: K <= S diag(share). Hence M^-1 K <= S max(share / m).
  const double border_share = families_.front().border_share;
  const Grid& grid = mass.grid();
  double most = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const double row_share = r == 0 || r == grid.rows - 1 ? border_share : 1.0;
    for (int c = 0; c < grid.cols; ++c) {
      const double col_share = c == 0 || c == grid.cols - 1 ? border_share : 1.0;
      most = std::max(most, row_share * col_share / double(mass.at(r, c)));
    }
  }
  // Room for the rounding of the masses and of whoever computes the eigenvalue.
  return LatticeStiffness(families_, stiffened).of_stiffest_wave() * most * (1 + 1e-6);
}

template double Springs<float>::max_squared_frequency(const Field<float>&) const;
template double Springs<float>::max_damping_rate(const Field<float>&) const;
template double Springs<float>::squared_frequency(const Field<float>&, bool) const;
template double Springs<double>::max_squared_frequency(const Field<double>&) const;
template double Springs<double>::max_damping_rate(const Field<double>&) const;
template double Springs<double>::squared_frequency(const Field<double>&, bool) const;

}  // namespace weft
