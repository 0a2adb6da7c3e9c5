#include "cloth/kernels/node_kernels.h"

#include "cloth/multiversion.h"

namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline void euler_component(const Real* __restrict force,
                                                   const Real* __restrict inverse_mass,
                                                   Real* __restrict acceleration, Real* __restrict velocity,
                                                   Real* __restrict position, Real h, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool free = inverse_mass[i] > Real(0);
    const Real a = free ? force[i] * inverse_mass[i] : Real(0);
    const Real moved = velocity[i] + a * h;
    const Real v = free ? moved : Real(0);
    acceleration[i] = a;
    velocity[i] = v;
    position[i] += v * h;
  }
}

template <class Real>
[[gnu::always_inline]] inline void euler_all(const EulerArrays<Real>& arrays, Real h, std::size_t count) {
  euler_component(arrays.force.x, arrays.inverse_mass, arrays.acceleration.x, arrays.velocity.x,
                  arrays.position.x, h, count);
  euler_component(arrays.force.y, arrays.inverse_mass, arrays.acceleration.y, arrays.velocity.y,
                  arrays.position.y, h, count);
  euler_component(arrays.force.z, arrays.inverse_mass, arrays.acceleration.z, arrays.velocity.z,
                  arrays.position.z, h, count);
}

template <class Real>
[[gnu::always_inline]] inline void add_weighted_constant_one(Real* __restrict force,
                                                             const Real* __restrict weight, Real value,
                                                             std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) force[i] += weight[i] * value;
}

template <class Real>
[[gnu::always_inline]] inline void add_scaled_one(Real* __restrict force, const Real* __restrict field,
                                                  Real factor, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) force[i] += factor * field[i];
}

template <class Real>
[[gnu::always_inline]] inline void add_weighted_one(Real* __restrict force, const Real* __restrict field,
                                                    const Real* __restrict weight, Real factor,
                                                    std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) force[i] += factor * weight[i] * field[i];
}

template <class Real>
[[gnu::always_inline]] inline bool all_finite_any(const Real* values, std::size_t count) {
  int bad = 0;
  // Only NaN and the infinities have a difference with themselves that is not zero.
  for (std::size_t i = 0; i < count; ++i) bad |= values[i] - values[i] == Real(0) ? 0 : 1;
  return bad == 0;
}

}  // namespace

WEFT_MULTIVERSION void euler_update(const EulerArrays<float>& arrays, float h, std::size_t count) {
  euler_all(arrays, h, count);
}
WEFT_MULTIVERSION void euler_update(const EulerArrays<double>& arrays, double h, std::size_t count) {
  euler_all(arrays, h, count);
}

WEFT_MULTIVERSION void add_weighted_constant(Components<float> force, const float* weight, float x, float y,
                                             float z, std::size_t count) {
  add_weighted_constant_one(force.x, weight, x, count);
  add_weighted_constant_one(force.y, weight, y, count);
  add_weighted_constant_one(force.z, weight, z, count);
}
WEFT_MULTIVERSION void add_weighted_constant(Components<double> force, const double* weight, double x,
                                             double y, double z, std::size_t count) {
  add_weighted_constant_one(force.x, weight, x, count);
  add_weighted_constant_one(force.y, weight, y, count);
  add_weighted_constant_one(force.z, weight, z, count);
}

WEFT_MULTIVERSION void add_scaled(Components<float> force, Components<const float> field, float factor,
                                  std::size_t count) {
  add_scaled_one(force.x, field.x, factor, count);
  add_scaled_one(force.y, field.y, factor, count);
  add_scaled_one(force.z, field.z, factor, count);
}
WEFT_MULTIVERSION void add_scaled(Components<double> force, Components<const double> field, double factor,
                                  std::size_t count) {
  add_scaled_one(force.x, field.x, factor, count);
  add_scaled_one(force.y, field.y, factor, count);
  add_scaled_one(force.z, field.z, factor, count);
}

WEFT_MULTIVERSION void add_weighted(Components<float> force, Components<const float> field,
                                    const float* weight, float factor, std::size_t count) {
  add_weighted_one(force.x, field.x, weight, factor, count);
  add_weighted_one(force.y, field.y, weight, factor, count);
  add_weighted_one(force.z, field.z, weight, factor, count);
}
WEFT_MULTIVERSION void add_weighted(Components<double> force, Components<const double> field,
                                    const double* weight, double factor, std::size_t count) {
  add_weighted_one(force.x, field.x, weight, factor, count);
  add_weighted_one(force.y, field.y, weight, factor, count);
  add_weighted_one(force.z, field.z, weight, factor, count);
}

WEFT_MULTIVERSION bool all_finite(const float* values, std::size_t count) {
  return all_finite_any(values, count);
}
WEFT_MULTIVERSION bool all_finite(const double* values, std::size_t count) {
  return all_finite_any(values, count);
}

}  // namespace weft::kernels
