#include "cloth/effects/paper_wind.h"

#include "cloth/kernels/air_kernels.h"

namespace weft {
namespace {

/// Lambda times the wind's speed, for each node (paper) or for the area it stands for, its mass over the
/// density.
template <class Real>
kernels::Push<Real> push_of(const EffectContext& context, double factor) {
  const double strength = factor * context.wind->speed;
  if (context.cloth->discretization == Discretization::paper) return {static_cast<Real>(strength), Real(0)};
  return {Real(0), static_cast<Real>(strength / context.cloth->material.density)};
}

}  // namespace

template <class Real>
void PaperWind<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                 VectorField<Real>& force) const {
  if (context.wind->speed == 0) return;
  const kernels::Push<Real> push = push_of<Real>(context, parameters_.factor);
  const Vec3& n = context.wind->direction;
  const kernels::Uniform<Real> direction{static_cast<Real>(n.x()), static_cast<Real>(n.y()),
                                         static_cast<Real>(n.z())};
  if (parameters_.along_normal) {
    kernels::add_push_along_normals(particles.grid(), kernels::components(particles.position),
                                    particles.mass.row(0), push, direction, kernels::components(force));
  } else {
    kernels::add_push(particles.grid(), particles.mass.row(0), push, direction, kernels::components(force));
  }
}

template class PaperWind<float>;
template class PaperWind<double>;

}  // namespace weft
