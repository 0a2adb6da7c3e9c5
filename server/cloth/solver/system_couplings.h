#pragma once
#include <span>

#include "cloth/solver/node_couplings.h"

namespace weft {

/// Springs between up to four nodes of several cloths' linear systems, which they join to one: each adds
/// W^T K W to it, where W x = sum of weight_i x_i and K is symmetric and not negative.
template <class Real>
class SystemCouplings {
 public:
  struct Coupling {
    std::array<std::size_t, 4> part{};  ///< whose node it is, counted from 0
    std::array<std::size_t, 4> node{};  ///< indices into its grid's arrays
    std::array<double, 4> weight{};     ///< 0: no such node, or a fixed one
    Eigen::Matrix3d stiffness;          ///< N/m
  };
  bool empty() const { return couplings_.empty(); }
  void clear() { couplings_.clear(); }
  void add(const Coupling& coupling) { couplings_.push_back(coupling); }

  /// y += W^T K W x of all, by parts; returns x . of what was added.
  double multiply(std::span<const kernels::Components<Real>> x,
                  std::span<const kernels::Components<Real>> y) const;

 private:
  std::vector<Coupling> couplings_;
};

extern template class SystemCouplings<float>;
extern template class SystemCouplings<double>;

}  // namespace weft
