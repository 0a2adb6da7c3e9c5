#include "cloth/forces/aerodynamics.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/air_kernels.h"

namespace weft {
namespace {

/// Calls with the air's velocity, the same everywhere or at each node.
template <class Real, class Call>
auto in_air(const EffectContext& context, const Call& call) {
  if (context.node_air != nullptr) return call(kernels::components(*context.node_air));
  const Vec3 v = context.wind_speed() * context.wind->direction;
  return call(
      kernels::Uniform<Real>{static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z())});
}

/// The same air from scalar n of the cloth's fields on.
template <class Real>
kernels::Uniform<Real> from(const kernels::Uniform<Real>& air, std::size_t) {
  return air;
}
kernels::Components<const float> from(const kernels::Components<const float>& air, std::size_t n) {
  return air + n;
}

template <class Real>
kernels::Plate<Real> plate_of(const AerodynamicsEffect& e) {
  return {static_cast<Real>(0.5 * e.air_density * e.lift_or_drag()),
          static_cast<Real>(0.5 * e.air_density * (e.drag - e.lift_or_drag()))};
}

}  // namespace

template <class Real>
void Aerodynamics<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                    VectorField<Real>& force) const {
  // An infinite limit becomes an infinite flow: no limit.
  const double most_flow = context.damping_limit / rate_per_flow(particles);
  in_air<Real>(context, [&](const auto& air) {
    for_each_whole_part(particles.grid(), context, [&](const Grid& faces, std::size_t n) {
      kernels::add_air_force(faces, kernels::components(particles.position) + n,
                             kernels::components(particles.velocity) + n, from(air, n),
                             plate_of<Real>(parameters_), static_cast<Real>(most_flow),
                             kernels::components(force) + n);
    });
  });
}

template <class Real>
double Aerodynamics<Real>::max_flow(const Particles<Real>& particles, const EffectContext& context) const {
  return in_air<Real>(context, [&](const auto& air) {
    Real most = 0;
    for_each_whole_part(particles.grid(), context, [&](const Grid& faces, std::size_t n) {
      most = std::max(most, kernels::max_air_flow(faces, kernels::components(particles.position) + n,
                                                  kernels::components(particles.velocity) + n, from(air, n)));
    });
    return double(most);
  });
}

template <class Real>
double Aerodynamics<Real>::max_damping_rate(const Particles<Real>& particles,
                                            const EffectContext& context) const {
  return max_flow(particles, context) * rate_per_flow(particles);
}

template <class Real>
double Aerodynamics<Real>::tension(const Particles<Real>& particles, const EffectContext& context) const {
  const Vec2& size = context.cloth->size;
  const double speed = max_flow(particles, context) * particles.grid().cells() / size.prod();
  const double pressure =
      0.5 * parameters_.air_density * std::max(parameters_.drag, parameters_.lift_or_drag()) * speed * speed;
  return pressure * size.maxCoeff();
}

template <class Real>
void Aerodynamics<Real>::add_damping(const Particles<Real>& particles, const EffectContext& context,
                                     const DampingMatrix<Real>& damping) const {
  in_air<Real>(context, [&](const auto& air) {
    for_each_whole_part(particles.grid(), context, [&](const Grid& faces, std::size_t n) {
      kernels::add_air_damping(faces, kernels::components(particles.position) + n,
                               kernels::components(particles.velocity) + n, from(air, n),
                               plate_of<Real>(parameters_), damping.blocks + n);
    });
  });
}

template <class Real>
double Aerodynamics<Real>::rate_per_flow(const Particles<Real>& particles) const {
  // -dF/dv of a face is rho C |w.A| n n^T, shared by its four corners. A node in the middle of the grid has
  // a quarter of each of its four faces; on the border it has fewer faces, and no more of them for its mass.
  // What drag differs from lift adds at most 1.1 times as much in any direction (air_kernels.h).
  const Grid& grid = particles.grid();
  const double lift = parameters_.lift_or_drag();
  const double coefficient = lift + 1.1 * std::abs(parameters_.drag - lift);
  return parameters_.air_density * coefficient / double(particles.mass.at(grid.rows / 2, grid.cols / 2));
}

template class Aerodynamics<float>;
template class Aerodynamics<double>;

}  // namespace weft
