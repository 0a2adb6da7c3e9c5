#include "cloth/effects/inflation.h"

#include "cloth/kernels/pressure_kernels.h"

namespace weft {

template <class Real>
void Inflation<Real>::add_forces(const Particles<Real>& particles, const EffectContext&,
                                 VectorField<Real>& force) const {
  const Grid& grid = particles.grid();
  work_.resize(kernels::pressure_work_size(grid));
  kernels::add_pressure(grid, kernels::components(particles.position),
                        static_cast<Real>(parameters_.pressure), kernels::components(force), work_.data());
}

template class Inflation<float>;
template class Inflation<double>;

}  // namespace weft
