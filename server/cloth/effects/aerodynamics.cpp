#include "cloth/effects/aerodynamics.h"

#include <algorithm>

#include "cloth/kernels/air_kernels.h"

namespace weft {
namespace {

template <class Real>
kernels::Uniform<Real> air_of(const Wind& wind) {
  const Vec3 v = wind.velocity();
  return {static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z())};
}

}  // namespace

template <class Real>
void Aerodynamics<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                    VectorField<Real>& force) const {
  kernels::add_air_pressure(particles.grid(), kernels::components(particles.position),
                            kernels::components(particles.velocity), air_of<Real>(*context.wind),
                            static_cast<Real>(0.5 * parameters_.air_density * parameters_.drag),
                            kernels::components(force));
}

template <class Real>
double Aerodynamics<Real>::max_damping_rate(const Particles<Real>& particles,
                                            const EffectContext& context) const {
  const Grid& grid = particles.grid();
  // -dF/dv of a face is rho C |w.A| n n^T, shared by its corners; a node's row adds up a quarter of each of
  // its faces.
  double corners_per_mass = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const int faces_down = r == 0 || r == grid.rows - 1 ? 1 : 2;
    for (int c = 0; c < grid.cols; ++c) {
      const int faces_across = c == 0 || c == grid.cols - 1 ? 1 : 2;
      corners_per_mass = std::max(corners_per_mass,
                                  0.25 * faces_down * faces_across * double(particles.inverse_mass.at(r, c)));
    }
  }
  const double flow =
      double(kernels::max_air_flow(grid, kernels::components(particles.position),
                                   kernels::components(particles.velocity), air_of<Real>(*context.wind)));
  return parameters_.air_density * parameters_.drag * flow * corners_per_mass;
}

template class Aerodynamics<float>;
template class Aerodynamics<double>;

}  // namespace weft
