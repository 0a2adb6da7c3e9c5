#pragma once
#include <type_traits>

#include "cloth/core/grid.h"

/// Kernels are row loops that the compiler vectorises for several instruction sets (multiversion.h). They
/// know no Eigen: its types change with the instruction set.
namespace weft::kernels {

/// The three arrays of a vector field, as a kernel sees them.
template <class T>
struct Components {
  T* x;
  T* y;
  T* z;

  // NOLINTNEXTLINE(google-explicit-constructor): as from T* to const T*
  operator Components<const T>() const requires(!std::is_const_v<T>) { return {x, y, z}; }
};

/// The same from scalar n on.
template <class T>
Components<T> operator+(const Components<T>& field, std::size_t n) {
  return {field.x + n, field.y + n, field.z + n};
}

template <class Real>
Components<Real> components(VectorField<Real>& field) {
  return {field.x.row(0), field.y.row(0), field.z.row(0)};
}
template <class Real>
Components<const Real> components(const VectorField<Real>& field) {
  return {field.x.row(0), field.y.row(0), field.z.row(0)};
}

}  // namespace weft::kernels
