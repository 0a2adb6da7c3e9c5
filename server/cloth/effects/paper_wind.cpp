#include "cloth/effects/paper_wind.h"

#include "cloth/kernels/air_kernels.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

/// Newtons on each node: lambda times the wind's speed, per node (paper) or times the area it stands for
/// (continuum).
template <class Real>
Field<Real> force_per_node(const Particles<Real>& particles, const EffectContext& context, double factor) {
  const Grid& grid = particles.grid();
  const double strength = factor * context.wind->speed;
  const bool by_area = context.cloth->discretization == Discretization::continuum;
  const auto per_mass = static_cast<Real>(strength / context.cloth->material.density);
  Field<Real> result(grid);
  for (int r = 0; r < grid.rows; ++r) {
    Real* out = result.row(r);
    const Real* mass = particles.mass.row(r);
    for (int c = 0; c < grid.cols; ++c) out[c] = by_area ? per_mass * mass[c] : static_cast<Real>(strength);
  }
  return result;
}

}  // namespace

template <class Real>
void PaperWind<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                 VectorField<Real>& force) const {
  if (context.wind->speed == 0) return;
  const Field<Real> weight = force_per_node(particles, context, parameters_.factor);
  const Vec3& n = context.wind->direction;
  const kernels::Air<Real> direction{static_cast<Real>(n.x()), static_cast<Real>(n.y()),
                                     static_cast<Real>(n.z())};
  if (parameters_.along_normal) {
    kernels::add_along_normals(particles.grid(), kernels::components(particles.position), direction,
                               weight.row(0), kernels::components(force));
  } else {
    kernels::add_weighted_constant(kernels::components(force), weight.row(0), direction.x, direction.y,
                                   direction.z, particles.grid().size());
  }
}

template class PaperWind<float>;
template class PaperWind<double>;

}  // namespace weft
