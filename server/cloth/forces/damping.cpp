#include "cloth/forces/damping.h"

#include <algorithm>

#include "cloth/kernels/node_kernels.h"

namespace weft {

template <class Real>
void Damping<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                               VectorField<Real>& force) const {
  const Material& material = context.cloth->material;
  const std::size_t count = particles.grid().size();
  if (context.cloth->discretization == Discretization::paper) {
    kernels::add_scaled(kernels::components(force), kernels::components(particles.velocity),
                        static_cast<Real>(-material.damping), count);
  } else {
    // The area a node stands for is its mass over the density.
    kernels::add_weighted(kernels::components(force), kernels::components(particles.velocity),
                          particles.mass.row(0), static_cast<Real>(-material.damping / material.density),
                          count);
  }
}

template <class Real>
double Damping<Real>::max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const {
  const Material& material = context.cloth->material;
  if (context.cloth->discretization == Discretization::continuum) return material.damping / material.density;
  const Grid& grid = particles.grid();
  Real most = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const Real* inverse_mass = particles.inverse_mass.row(r);
    most = std::max(most, *std::max_element(inverse_mass, inverse_mass + grid.cols));
  }
  return material.damping * double(most);
}

template <class Real>
void Damping<Real>::add_damping(const Particles<Real>& particles, const EffectContext& context,
                                const DampingMatrix<Real>& damping) const {
  const Material& material = context.cloth->material;
  const bool paper = context.cloth->discretization == Discretization::paper;
  const Real per_node = paper ? static_cast<Real>(material.damping) : Real(0);
  const Real per_mass = paper ? Real(0) : static_cast<Real>(material.damping / material.density);
  const Real* mass = particles.mass.row(0);
  for (std::size_t i = 0; i < particles.grid().size(); ++i)
    damping.scalar[i] += per_node + per_mass * mass[i];
}

template class Damping<float>;
template class Damping<double>;

}  // namespace weft
