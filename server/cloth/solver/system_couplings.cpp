#include "cloth/solver/system_couplings.h"

#include "cloth/kernels/node_vector.h"

namespace weft {

template <class Real>
double SystemCouplings<Real>::multiply(std::span<const kernels::Components<Real>> x,
                                       std::span<const kernels::Components<Real>> y) const {
  double product = 0;
  for (const Coupling& c : couplings_) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 0; i < 4; ++i) sum += c.weight[i] * at<Real>(x[c.part[i]], c.node[i]);
    const Vec3 force = c.stiffness * sum;
    product += sum.dot(force);
    for (std::size_t i = 0; i < 4; ++i) weft::add<Real>(y[c.part[i]], c.node[i], Vec3(c.weight[i] * force));
  }
  return product;
}

template class SystemCouplings<float>;
template class SystemCouplings<double>;

}  // namespace weft
