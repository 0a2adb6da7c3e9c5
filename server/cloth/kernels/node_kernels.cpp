#include "cloth/kernels/node_kernels.h"

#include <cmath>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline void euler_any(const EulerArrays<Real>& arrays, Real h, std::size_t count) {
  const Components<const Real> force = arrays.force;
  const Components<Real> a = arrays.acceleration, v = arrays.velocity, r = arrays.position;
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Real inverse_mass = arrays.inverse_mass[i];
    const bool free = inverse_mass > Real(0);
    const Real ax = free ? force.x[i] * inverse_mass : Real(0);
    const Real ay = free ? force.y[i] * inverse_mass : Real(0);
    const Real az = free ? force.z[i] * inverse_mass : Real(0);
    const Real vx = free ? v.x[i] + ax * h : Real(0);
    const Real vy = free ? v.y[i] + ay * h : Real(0);
    const Real vz = free ? v.z[i] + az * h : Real(0);
    a.x[i] = ax;
    a.y[i] = ay;
    a.z[i] = az;
    v.x[i] = vx;
    v.y[i] = vy;
    v.z[i] = vz;
    r.x[i] += vx * h;
    r.y[i] += vy * h;
    r.z[i] += vz * h;
  }
}

template <class Real>
[[gnu::always_inline]] inline void add_weighted_constant_any(const Components<Real>& force,
                                                             const Real* weight, Real x, Real y, Real z,
                                                             std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    force.x[i] += weight[i] * x;
    force.y[i] += weight[i] * y;
    force.z[i] += weight[i] * z;
  }
}

template <class Real>
[[gnu::always_inline]] inline void add_scaled_any(const Components<Real>& force,
                                                  const Components<const Real>& field, Real factor,
                                                  std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    force.x[i] += factor * field.x[i];
    force.y[i] += factor * field.y[i];
    force.z[i] += factor * field.z[i];
  }
}

template <class Real>
[[gnu::always_inline]] inline void add_weighted_any(const Components<Real>& force,
                                                    const Components<const Real>& field, const Real* weight,
                                                    Real factor, std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Real scale = factor * weight[i];
    force.x[i] += scale * field.x[i];
    force.y[i] += scale * field.y[i];
    force.z[i] += scale * field.z[i];
  }
}

template <class Real>
[[gnu::always_inline]] inline bool all_finite_any(const Real* values, std::size_t count) {
  int bad = 0;
  // Only NaN and the infinities have a difference with themselves that is not zero.
  for (std::size_t i = 0; i < count; ++i) bad |= values[i] - values[i] == Real(0) ? 0 : 1;
  return bad == 0;
}

template <class Real>
[[gnu::always_inline]] inline bool all_within_any(const Components<const Real>& a,
                                                  const Components<const Real>& b, Real distance,
                                                  std::size_t count) {
  int bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bad |= std::abs(a.x[i] - b.x[i]) <= distance ? 0 : 1;
    bad |= std::abs(a.y[i] - b.y[i]) <= distance ? 0 : 1;
    bad |= std::abs(a.z[i] - b.z[i]) <= distance ? 0 : 1;
  }
  return bad == 0;
}

}  // namespace

WEFT_MULTIVERSION void euler_update(const EulerArrays<float>& arrays, float h, std::size_t count) {
  euler_any(arrays, h, count);
}
WEFT_MULTIVERSION void euler_update(const EulerArrays<double>& arrays, double h, std::size_t count) {
  euler_any(arrays, h, count);
}

WEFT_MULTIVERSION void add_weighted_constant(Components<float> force, const float* weight, float x, float y,
                                             float z, std::size_t count) {
  add_weighted_constant_any(force, weight, x, y, z, count);
}
WEFT_MULTIVERSION void add_weighted_constant(Components<double> force, const double* weight, double x,
                                             double y, double z, std::size_t count) {
  add_weighted_constant_any(force, weight, x, y, z, count);
}

WEFT_MULTIVERSION void add_scaled(Components<float> force, Components<const float> field, float factor,
                                  std::size_t count) {
  add_scaled_any(force, field, factor, count);
}
WEFT_MULTIVERSION void add_scaled(Components<double> force, Components<const double> field, double factor,
                                  std::size_t count) {
  add_scaled_any(force, field, factor, count);
}

WEFT_MULTIVERSION void add_weighted(Components<float> force, Components<const float> field,
                                    const float* weight, float factor, std::size_t count) {
  add_weighted_any(force, field, weight, factor, count);
}
WEFT_MULTIVERSION void add_weighted(Components<double> force, Components<const double> field,
                                    const double* weight, double factor, std::size_t count) {
  add_weighted_any(force, field, weight, factor, count);
}

WEFT_MULTIVERSION bool all_within(Components<const float> a, Components<const float> b, float distance,
                                  std::size_t count) {
  return all_within_any(a, b, distance, count);
}
WEFT_MULTIVERSION bool all_within(Components<const double> a, Components<const double> b, double distance,
                                  std::size_t count) {
  return all_within_any(a, b, distance, count);
}

WEFT_MULTIVERSION bool all_finite(const float* values, std::size_t count) {
  return all_finite_any(values, count);
}
WEFT_MULTIVERSION bool all_finite(const double* values, std::size_t count) {
  return all_finite_any(values, count);
}

}  // namespace weft::kernels
