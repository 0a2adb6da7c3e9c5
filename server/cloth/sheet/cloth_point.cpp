#include "cloth/sheet/cloth_point.h"

namespace weft {

template <class Real>
ClothPoint<Real>::ClothPoint(const PointId& id, const Particles<Real>& particles) {
  const Real* inverse_mass = particles.inverse_mass.row(0);
  node_[0] = id.node;
  if (!id.between_nodes()) {
    moves_[0] = 1;
    mass_ = double(particles.mass.row(0)[id.node]);
    return;
  }
  const auto stride = static_cast<std::size_t>(particles.grid().stride);
  const double u = id.u(), v = id.v();
  count_ = 0;
  add_node(id.node, (1 - u) * (1 - v));
  if (u > 0) add_node(id.node + 1, u * (1 - v));
  if (v > 0) add_node(id.node + stride, (1 - u) * v);
  if (u > 0 && v > 0) add_node(id.node + stride + 1, u * v);
  double mobility = 0;  // 1/kg
  for (std::size_t k = 0; k < count_; ++k) {
    const auto inverse = double(inverse_mass[node_[k]]);
    moves_[k] = inverse > 0 ? weight_[k] : 0;
    gain_[k] = moves_[k] * inverse;
    mobility += moves_[k] * gain_[k];
  }
  for (std::size_t k = 0; k < count_ && mobility > 0; ++k) gain_[k] /= mobility;
  mass_ = mobility > 0 ? 1 / mobility : 0;
}

template class ClothPoint<float>;
template class ClothPoint<double>;

}  // namespace weft
