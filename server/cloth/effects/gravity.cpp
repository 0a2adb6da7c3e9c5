#include "cloth/effects/gravity.h"

#include "cloth/diagnostics.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {

template <class Real>
void Gravity<Real>::add_forces(const Particles<Real>& particles, const EffectContext&,
                               VectorField<Real>& force) const {
  const Vec3& g = parameters_.acceleration;
  kernels::add_weighted_constant(kernels::components(force), particles.mass.row(0), static_cast<Real>(g.x()),
                                 static_cast<Real>(g.y()), static_cast<Real>(g.z()), particles.grid().size());
}

template <class Real>
double Gravity<Real>::energy(const Particles<Real>& particles) const {
  return gravitational_energy(particles, parameters_.acceleration);
}

template class Gravity<float>;
template class Gravity<double>;

}  // namespace weft
