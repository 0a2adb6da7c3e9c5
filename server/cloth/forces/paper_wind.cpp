#include "cloth/forces/paper_wind.h"

#include "cloth/kernels/push_kernels.h"

namespace weft {
namespace {

/// A strength in N for each node (paper) or for the area it stands for, its mass over the density.
template <class Real>
kernels::Push<Real> push_of(const ClothDescription& cloth, double strength) {
  if (cloth.discretization == Discretization::paper) return {static_cast<Real>(strength), Real(0)};
  return {Real(0), static_cast<Real>(strength / cloth.material.density)};
}

}  // namespace

template <class Real>
void PaperWind<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                 VectorField<Real>& force) const {
  const auto add = [&](const kernels::Push<Real>& push, const auto& wind) {
    if (parameters_.along_normal) {
      kernels::add_push_along_normals(particles.grid(), kernels::components(particles.position),
                                      particles.mass.row(0), push, wind, kernels::components(force));
    } else {
      kernels::add_push(particles.grid(), particles.mass.row(0), push, wind, kernels::components(force));
    }
  };
  if (context.node_air != nullptr) {
    add(push_of<Real>(*context.cloth, parameters_.factor), kernels::components(*context.node_air));
  } else if (const double speed = context.wind_speed(); speed != 0) {
    const Vec3& n = context.wind->direction;
    add(push_of<Real>(*context.cloth, parameters_.factor * speed),
        kernels::Uniform<Real>{static_cast<Real>(n.x()), static_cast<Real>(n.y()), static_cast<Real>(n.z())});
  }
}

template class PaperWind<float>;
template class PaperWind<double>;

}  // namespace weft
