#include "cloth/solver/node_couplings.h"

#include "cloth/kernels/node_vector.h"

namespace weft {

template <class Real>
double NodeCouplings<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const {
  double product = 0;
  for (const Coupling& c : couplings_) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 0; i < 4; ++i) sum += c.weight[i] * at(x, c.node[i]);
    const Vec3 force = c.stiffness * sum;
    product += sum.dot(force);
    for (std::size_t i = 0; i < 4; ++i) weft::add(y, c.node[i], Vec3(c.weight[i] * force));
  }
  return product;
}

template class NodeCouplings<float>;
template class NodeCouplings<double>;

}  // namespace weft
