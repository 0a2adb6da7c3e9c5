#pragma once
#include <vector>

#include "cloth/material.h"
#include "cloth/particles.h"

namespace weft {

/// One kind of spring between node (r, c) and node (r + rows, c + cols), all of one rest length. Fig. 1's three
/// kinds make six families: structural (0,1) (1,0), shear (1,1) (1,-1), bending (0,2) (2,0).
struct SpringFamily {
  int rows = 0, cols = 0;      ///< offset to the other end; cols may be negative
  double rest_length = 0;      ///< m
  double stiffness = 0;        ///< N/m, of a spring away from the border
  double border_share = 1;     ///< stiffness of a spring lying in the border row or column, relative: 1 (paper), 0.5
};

/// Energy of one spring, J: 1/2 k (|d| - l0)^2, with d = r_i - r_j.
double spring_energy(const Vec3& d, double rest_length, double stiffness);
/// Force on end i, N: Eq. 1's summand, -k (|d| - l0) d / |d|; zero for coincident ends (no direction to push in).
Vec3 spring_force(const Vec3& d, double rest_length, double stiffness);
/// Stiffness -dF_i/dr_i, N/m: k n n^T + k (1 - l0/|d|) (I - n n^T); zero for coincident ends.
Eigen::Matrix3d spring_stiffness(const Vec3& d, double rest_length, double stiffness);

struct StructuralStrain {
  double max = 0;   ///< largest |l - l0| / l0 over structural springs
  double mean = 0;  ///< mean of the same
};

/// The springs of one cloth at one level. Families of zero stiffness are left out: they cost nothing.
template <class Real>
class Springs {
 public:
  Springs() = default;
  /// `size` is the cloth's width and height, m. Continuum constants for cells hx by hy: structural Y hy/hx along u,
  /// Y hx/hy along v; shear G d^2 / (2 hx hy) with d the diagonal; bending as structural at twice the distance.
  Springs(const Material& material, Discretization discretization, const Vec2& size, const Grid& grid);

  const std::vector<SpringFamily>& families() const { return families_; }

  /// Adds Eq. 1's force on every node, N.
  void add_forces(const VectorField<Real>& position, VectorField<Real>& force) const;
  /// J.
  double energy(const VectorField<Real>& position) const;
  StructuralStrain structural_strain(const VectorField<Real>& position) const;
  /// A bound on the largest eigenvalue of M^-1 K, 1/s2, whatever the cloth's shape: the squared angular frequency of
  /// the stiffest mode. From the lattice's dispersion relation, springs all aligned (worst case), any wave vector.
  double max_squared_frequency(const Field<Real>& mass) const;

 private:
  std::vector<SpringFamily> families_;
};

extern template class Springs<float>;
extern template class Springs<double>;

}  // namespace weft
