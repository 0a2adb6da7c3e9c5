#pragma once
#include <algorithm>

#include "cloth/core/vec3.h"
#include "cloth/kernels/components.h"

namespace weft {

/// The vector of one node in a field; sums over few nodes are made in double precision.
template <class Real>
Vec3 at(const kernels::Components<const Real>& field, std::size_t node) {
  return {double(field.x[node]), double(field.y[node]), double(field.z[node])};
}

/// field[node] = value.
template <class Real>
void set(const kernels::Components<Real>& field, std::size_t node, const Vec3& value) {
  field.x[node] = static_cast<Real>(value.x());
  field.y[node] = static_cast<Real>(value.y());
  field.z[node] = static_cast<Real>(value.z());
}

/// field[node] += value.
template <class Real>
void add(const kernels::Components<Real>& field, std::size_t node, const Vec3& value) {
  field.x[node] += static_cast<Real>(value.x());
  field.y[node] += static_cast<Real>(value.y());
  field.z[node] += static_cast<Real>(value.z());
}

/// to[node] = from[node] for the first `count` nodes.
template <class Real>
void copy(kernels::Components<const Real> from, kernels::Components<Real> to, std::size_t count) {
  std::copy_n(from.x, count, to.x);
  std::copy_n(from.y, count, to.y);
  std::copy_n(from.z, count, to.z);
}

/// field[node] = 0 for the first `count` nodes.
template <class Real>
void clear(const kernels::Components<Real>& field, std::size_t count) {
  for (Real* component : {field.x, field.y, field.z}) std::fill_n(component, count, Real(0));
}

}  // namespace weft
