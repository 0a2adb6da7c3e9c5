#include "cloth/effects/aerodynamics.h"

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
  // An infinite limit becomes an infinite flow: no limit.
  const double most_flow = context.damping_limit / rate_per_flow(particles);
  kernels::add_air_pressure(particles.grid(), kernels::components(particles.position),
                            kernels::components(particles.velocity), air_of<Real>(*context.wind),
                            static_cast<Real>(0.5 * parameters_.air_density * parameters_.drag),
                            static_cast<Real>(most_flow), kernels::components(force));
}

template <class Real>
double Aerodynamics<Real>::max_damping_rate(const Particles<Real>& particles,
                                            const EffectContext& context) const {
  const double flow =
      double(kernels::max_air_flow(particles.grid(), kernels::components(particles.position),
                                   kernels::components(particles.velocity), air_of<Real>(*context.wind)));
  return flow * rate_per_flow(particles);
}

template <class Real>
void Aerodynamics<Real>::add_damping(const Particles<Real>& particles, const EffectContext& context,
                                     const DampingMatrix<Real>& damping) const {
  kernels::add_air_damping(particles.grid(), kernels::components(particles.position),
                           kernels::components(particles.velocity), air_of<Real>(*context.wind),
                           static_cast<Real>(0.5 * parameters_.air_density * parameters_.drag),
                           damping.blocks);
}

template <class Real>
double Aerodynamics<Real>::rate_per_flow(const Particles<Real>& particles) const {
  // -dF/dv of a face is rho C |w.A| n n^T, shared by its four corners. A node in the middle of the grid has
  // a quarter of each of its four faces; on the border it has fewer faces, and no more of them for its mass.
  const Grid& grid = particles.grid();
  return parameters_.air_density * parameters_.drag / double(particles.mass.at(grid.rows / 2, grid.cols / 2));
}

template class Aerodynamics<float>;
template class Aerodynamics<double>;

}  // namespace weft
