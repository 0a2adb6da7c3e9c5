#include "cloth/forces/gravity.h"

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
  const Grid& grid = particles.grid();
  double sum = 0;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c)
      sum -=
          double(particles.mass.at(r, c)) * parameters_.acceleration.dot(particles.local_position_at(r, c));
  }
  return sum;
}

template class Gravity<float>;
template class Gravity<double>;

}  // namespace weft
