#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// What symplectic Euler reads and writes, node by node.
template <class Real>
struct EulerArrays {
  Components<const Real> force;
  const Real* inverse_mass;
  Components<Real> acceleration, velocity, position;
};

/// Eq. 6 for `count` scalars: a = F/m, v += a h, r += v h. Where inverse_mass is 0, a and v become 0.
void euler_update(const EulerArrays<float>& arrays, float h, std::size_t count);
void euler_update(const EulerArrays<double>& arrays, double h, std::size_t count);

/// force += weight * (x, y, z).
void add_weighted_constant(Components<float> force, const float* weight, float x, float y, float z,
                           std::size_t count);
void add_weighted_constant(Components<double> force, const double* weight, double x, double y, double z,
                           std::size_t count);

/// force += factor * field.
void add_scaled(Components<float> force, Components<const float> field, float factor, std::size_t count);
void add_scaled(Components<double> force, Components<const double> field, double factor, std::size_t count);

/// force += factor * weight * field.
void add_weighted(Components<float> force, Components<const float> field, const float* weight, float factor,
                  std::size_t count);
void add_weighted(Components<double> force, Components<const double> field, const double* weight,
                  double factor, std::size_t count);

/// Whether no component of a differs from b's by more than `distance`; false if one is NaN.
bool all_within(Components<const float> a, Components<const float> b, float distance, std::size_t count);
bool all_within(Components<const double> a, Components<const double> b, double distance, std::size_t count);

bool all_finite(const float* values, std::size_t count);
bool all_finite(const double* values, std::size_t count);

}  // namespace weft::kernels
