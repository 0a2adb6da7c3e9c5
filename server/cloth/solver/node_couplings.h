#pragma once
#include <array>
#include <vector>

#include "cloth/kernels/link_kernels.h"
#include "cloth/vec3.h"

namespace weft {

/// Springs between up to four nodes of an implicit step's linear system, beyond the links of the grid: each
/// adds W^T K W to A, where W x = sum of weight_i x_i and K is symmetric and not negative. Part of A and, on
/// the finest grid, of its preconditioner: coarse grids know nothing of them. A strip wrung by
/// three turns takes 0.61 times the iterations and 0.86 times the instructions so at level 4; by two turns at
/// level 5, 0.82 times the instructions.
template <class Real>
class NodeCouplings {
 public:
  struct Coupling {
    std::array<std::size_t, 4> node{};  ///< indices into the grid's arrays
    std::array<double, 4> weight{};     ///< 0: no such node, or a fixed one
    Eigen::Matrix3d stiffness;          ///< N/m
  };
  bool empty() const { return couplings_.empty(); }
  void clear() { couplings_.clear(); }
  void add(const Coupling& coupling) { couplings_.push_back(coupling); }

  /// y += W^T K W x of all; returns x . of what was added.
  double multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const;

  // The smoother. All that follows is of the couplings as prepare() was called.

  /// Takes the couplings into block Jacobi's `inverse`, which is of `damping` times the links' diagonal
  /// blocks inverted: to node i's block each adds |weight_i| (sum of |weight|) / 2 K. Then W^T K W is at most
  /// twice the sum of what it adds (by Cauchy and Schwarz), as is a link's matrix, and damping below 1 stays
  /// safe; between two nodes it is the very diagonal.
  void prepare(double damping, const kernels::Blocks<Real>& inverse);
  /// y -= W^T K W x of all.
  void subtract(kernels::Components<const Real> x, kernels::Components<Real> y) const;
  /// z -= inverse W^T K W x of all; returns b . of what was added.
  double relax(kernels::Components<const Real> x, kernels::Components<const Real> b,
               kernels::Components<Real> z);

 private:
  /// Calls visit(node, force) of all of W^T K W x; returns x . W^T K W x.
  template <class Visit>
  double for_each_force(kernels::Components<const Real> x, Visit visit) const;

  std::vector<Coupling> couplings_;
  std::vector<std::size_t> nodes_;        ///< that are coupled
  std::vector<std::size_t> place_;        ///< of each node among them, from 1; 0: it is not
  std::vector<Eigen::Matrix3d> inverse_;  ///< theirs
  std::vector<Vec3> forces_;              ///< work space of relax
};

extern template class NodeCouplings<float>;
extern template class NodeCouplings<double>;

}  // namespace weft
