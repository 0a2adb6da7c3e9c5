#include "cloth/forces/inflation.h"

#include "cloth/kernels/pressure_kernels.h"

namespace weft {

template <class Real>
void Inflation<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                 VectorField<Real>& force) const {
  const Grid& grid = particles.grid();
  work_.resize(kernels::pressure_work_size(grid));
  for_each_whole_part(grid, context, [&](const Grid& faces, std::size_t first) {
    kernels::add_pressure(faces, kernels::components(particles.position) + first,
                          static_cast<Real>(parameters_.pressure), kernels::components(force) + first,
                          work_.data());
  });
}

template class Inflation<float>;
template class Inflation<double>;

}  // namespace weft
