#include "cloth/solver/node_couplings.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "cloth/solver/node_vector.h"

namespace weft {
namespace {

template <class Real>
Eigen::Matrix3d block_at(const kernels::Blocks<Real>& b, std::size_t i) {
  const auto xy = double(b.xy[i]), xz = double(b.xz[i]), yz = double(b.yz[i]);
  return Eigen::Matrix3d{{double(b.xx[i]), xy, xz}, {xy, double(b.yy[i]), yz}, {xz, yz, double(b.zz[i])}};
}

template <class Real>
void set_block(const kernels::Blocks<Real>& b, std::size_t i, const Eigen::Matrix3d& block) {
  b.xx[i] = static_cast<Real>(block(0, 0));
  b.xy[i] = static_cast<Real>(block(0, 1));
  b.xz[i] = static_cast<Real>(block(0, 2));
  b.yy[i] = static_cast<Real>(block(1, 1));
  b.yz[i] = static_cast<Real>(block(1, 2));
  b.zz[i] = static_cast<Real>(block(2, 2));
}

}  // namespace

template <class Real>
template <class Visit>
double NodeCouplings<Real>::for_each_force(kernels::Components<const Real> x, Visit visit) const {
  double product = 0;
  for (const Coupling& c : couplings_) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 0; i < 4; ++i) sum += c.weight[i] * at(x, c.node[i]);
    const Vec3 force = c.stiffness * sum;
    product += sum.dot(force);
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.weight[i] != 0) visit(c.node[i], Vec3(c.weight[i] * force));
    }
  }
  return product;
}

template <class Real>
double NodeCouplings<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const {
  return for_each_force(x, [&](std::size_t node, const Vec3& force) { weft::add(y, node, force); });
}

template <class Real>
void NodeCouplings<Real>::subtract(kernels::Components<const Real> x, kernels::Components<Real> y) const {
  for_each_force(x, [&](std::size_t node, const Vec3& force) { weft::add(y, node, Vec3(-force)); });
}

template <class Real>
void NodeCouplings<Real>::prepare(double damping, const kernels::Blocks<Real>& inverse) {
  for (const std::size_t node : nodes_) place_[node] = 0;
  nodes_.clear();
  inverse_.clear();
  for (const Coupling& c : couplings_) {
    double weights = 0;
    for (const double w : c.weight) weights += std::abs(w);
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.weight[i] == 0) continue;
      const std::size_t node = c.node[i];
      if (node >= place_.size()) place_.resize(node + 1, 0);
      if (place_[node] == 0) {
        nodes_.push_back(node);
        place_[node] = nodes_.size();
        inverse_.emplace_back(Eigen::Matrix3d::Zero());
      }
      inverse_[place_[node] - 1] += std::abs(c.weight[i]) * weights / 2 * c.stiffness;
    }
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Eigen::Matrix3d links = damping * block_at(inverse, nodes_[k]).inverse();
    inverse_[k] = damping * (links + inverse_[k]).inverse();
    set_block(inverse, nodes_[k], inverse_[k]);
  }
  forces_.assign(nodes_.size(), Vec3(0, 0, 0));
}

template <class Real>
double NodeCouplings<Real>::relax(kernels::Components<const Real> x, kernels::Components<const Real> b,
                                  kernels::Components<Real> z) {
  std::fill(forces_.begin(), forces_.end(), Vec3(0, 0, 0));
  for_each_force(x, [&](std::size_t node, const Vec3& force) { forces_[place_[node] - 1] += force; });
  double product = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Vec3 change = -inverse_[k] * forces_[k];
    weft::add(z, nodes_[k], change);
    product += change.dot(at(b, nodes_[k]));
  }
  return product;
}

template class NodeCouplings<float>;
template class NodeCouplings<double>;

}  // namespace weft
