#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/kernels/spring_energy_kernels.h"
#include "cloth/kernels/state_kernels.h"
#include "cloth/sheet/material.h"
#include "cloth/sheet/spring_family.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// Energy of one spring, J: 1/2 k (|d| - l0)^2, with d = r_i - r_j. One that stiffens by the factor s beyond
/// l1 (StrainLimitEffect) has 1/2 (s - 1) k max(0, |d| - l1)^2 besides, as if a slack spring lay beside it.
double spring_energy(const Vec3& d, double rest_length, double stiffness, const SpringLimit& limit = {});
/// Force on end i, N: Eq. 1's summand, -k (|d| - l0) d / |d|, and the slack spring's; zero for coincident
/// ends (no direction to push in).
Vec3 spring_force(const Vec3& d, double rest_length, double stiffness, const SpringLimit& limit = {});
/// Stiffness -dF_i/dr_i, N/m: k n n^T + k (1 - l0/|d|) (I - n n^T), and the slack spring's where it is not
/// slack; zero for coincident ends.
Eigen::Matrix3d spring_stiffness(const Vec3& d, double rest_length, double stiffness,
                                 const SpringLimit& limit = {});

/// Over structural springs; both extremes are at least 0. Where cloth crumples springs are compressed, and
/// nothing is stretched.
struct StructuralStrain {
  double max = 0;              ///< largest stretch, (l - l0) / l0
  double max_compression = 0;  ///< largest shortening, (l0 - l) / l0
  double mean = 0;             ///< mean of |l - l0| / l0
};

/// The springs of one cloth at one level. Families of zero stiffness are left out: they cost nothing. With a
/// damping time tau, s, each spring resists the rate of its length as well (StrainDampingEffect); `limited`
/// structural and shear springs stiffen where the material says (StrainLimitEffect).
template <class Real>
class Springs {
 public:
  Springs() = default;
  /// `size` is the cloth's width and height, m. Continuum constants for cells hx by hy: structural Y hy/hx
  /// of the warp's Y along u, Y hx/hy of the weft's along v; shear G d^2 / (2 hx hy) with d the diagonal;
  /// bending as structural at twice the distance, B hy/(2 hx) and B hx/(2 hy).
  Springs(const Material& material, Discretization discretization, const Vec2& size, const Grid& grid,
          double damping_time = 0, bool limited = false);

  const std::vector<SpringFamily>& families() const { return families_; }

  /// Springs that are cut are there no more; nullptr: none is.
  void tear(std::shared_ptr<const TornLinks> torn);
  const std::shared_ptr<const TornLinks>& torn() const { return torn_; }
  bool torn(const SpringFamily& family, int r, int c) const {
    return torn_ != nullptr && torn_->torn(r, c, family.rows, family.cols);
  }

  /// Adds Eq. 1's force on every node, N.
  void add_forces(const VectorField<Real>& position, VectorField<Real>& force) const;
  double damping_time() const { return damping_time_; }  ///< s; 0: undamped
  bool limited() const { return limited_; }
  /// Adds the damping of nodes at this velocity, N: on end i of every spring -tau k n (n . (v_i - v_j)).
  /// Nothing where undamped.
  void add_damping(const VectorField<Real>& position, kernels::Components<const Real> velocity,
                   VectorField<Real>& force) const;
  /// The same of nodes that came to `position` by `way` in `time` seconds, by how much longer that has made
  /// the springs: each turns on its way, and along where it ends a turn alone would look like a change.
  void add_damping(const VectorField<Real>& position, kernels::Components<const Real> way, double time,
                   VectorField<Real>& force) const;
  /// Adds a damping by `time` of what the springs gain beyond their limits, N; the nodes move at `velocity`.
  void add_limit_damping(const VectorField<Real>& position, const VectorField<Real>& velocity, double time,
                         VectorField<Real>& force) const;
  /// Linearises every spring at `position`, given with its rows of zeros (kernels/link_kernels.h); of a step
  /// of `h` seconds, in which damping stiffens a spring along itself by 1 + tau / h.
  void linearise(const Grid& grid, kernels::Components<const Real> position,
                 const kernels::LinkFamilies<kernels::SpringLinks<Real>>& links,
                 double h = std::numeric_limits<double>::infinity()) const;
  /// How far the springs' energy after `change` is from what linearise() at `position` promised; both fields
  /// with their rows of zeros.
  kernels::SpringModelError model_error(const Grid& grid, kernels::Components<const Real> position,
                                        kernels::Components<const Real> change) const;
  bool has_bending() const;
  /// Stiffness of all springs at a node away from the border, N/m, beyond their limits where they have any.
  double node_stiffness() const;
  /// J.
  double energy(const VectorField<Real>& position) const;
  /// J, of all springs of a whole sheet at twice their length, by their stiffness short of any limit.
  double energy_at_twice(const Grid& grid) const;
  StructuralStrain structural_strain(const VectorField<Real>& position) const;
  /// The largest strain of a structural or shear spring, and speed of one's ends past each other.
  kernels::SpringMotion motion(const Particles<Real>& particles) const;
  /// A bound on the largest eigenvalue of M^-1 K, 1/s2, whatever the cloth's shape: the squared angular
  /// frequency of the stiffest mode. From the lattice's dispersion relation, springs all aligned (worst
  /// case) and beyond their limits, any wave vector; a border node counts by the share of the lattice it
  /// stands for.
  double max_squared_frequency(const Field<Real>& mass) const;
  /// The same of what the springs' damping does, 1/s. What they gain beyond their limits is not damped.
  double max_damping_rate(const Field<Real>& mass) const;

 private:
  kernels::SpringLattice<Real> lattice(const Grid& grid) const;
  /// Whole rows of stiffness, where no spring lies beside the grid.
  void fill_columns();
  double squared_frequency(const Field<Real>& mass, bool stiffened) const;

  std::vector<SpringFamily> families_;
  double damping_time_ = 0;
  bool limited_ = false;
  Grid grid_;
  std::shared_ptr<const TornLinks> torn_;  ///< nullptr while the cloth is whole
  /// Stiffness by column of each family's first end, a row for each of the six; where torn, a grid for each.
  std::vector<Real, AlignedAllocator<Real>> columns_;
  /// The force kernel's work rows: no state, but one owner at a time.
  mutable std::vector<Real, AlignedAllocator<Real>> work_;
  mutable std::vector<Real, AlignedAllocator<Real>>
      damping_work_;  ///< empty where neither damped nor limited
};

extern template class Springs<float>;
extern template class Springs<double>;

}  // namespace weft
