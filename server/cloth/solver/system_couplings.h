#pragma once
#include <span>

#include "cloth/solver/node_couplings.h"

namespace weft {

/// NodeCouplings between nodes of several cloths' linear systems, which they join to one.
template <class Real>
class SystemCouplings {
 public:
  struct Coupling : NodeCouplings<Real>::Coupling {
    std::array<std::size_t, 4> part{};  ///< whose node it is, counted from 0
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
