#pragma once
#include <array>
#include <vector>

#include "cloth/core/vec3.h"
#include "cloth/kernels/components.h"

namespace weft {

/// Springs between up to four nodes of an implicit step's linear system, beyond the links of the grid: each
/// adds W^T K W to A, where W x = sum of weight_i x_i and K is symmetric and not negative. Part of A, but not
/// of its preconditioner.
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

 private:
  std::vector<Coupling> couplings_;
};

extern template class NodeCouplings<float>;
extern template class NodeCouplings<double>;

}  // namespace weft
