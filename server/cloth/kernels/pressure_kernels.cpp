#include "cloth/kernels/pressure_kernels.h"

#include "cloth/kernels/link_rows.h"

namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
[[gnu::always_inline]] inline Triple<Real> difference(const Components<const Real>& field, std::ptrdiff_t i,
                                                      std::ptrdiff_t from) {
  return {field.x[i] - field.x[from], field.y[i] - field.y[from], field.z[i] - field.z[from]};
}

template <class Real>
[[gnu::always_inline]] inline void add_rows(const Components<Real>& to, const Components<Real>& from,
                                            int count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    to.x[c] += from.x[c];
    to.y[c] += from.y[c];
    to.z[c] += from.z[c];
  }
}

/// The cells whose upper left corners lie in one row, which begins at `first`. Forces on right corners wait
/// in `upper` and `lower` until the pass is over.
template <class Real>
[[gnu::always_inline]] inline void add_cells(const Grid& grid, const Components<const Real>& position,
                                             Real twelfth, const Components<Real>& force,
                                             const Components<Real>& upper, const Components<Real>& lower,
                                             std::ptrdiff_t first) {
  const std::ptrdiff_t stride = grid.stride;
  const int count = grid.cols - 1;
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    // Corners a, b, c, d go round against the clock as seen from the face: b is below a, c opposite. n1 to n3
    // are twice the areas of the triangles abc, acd and abd; that of bcd is n1 + n2 - n3.
    const std::ptrdiff_t a = first + c;
    const Triple<Real> to_b = difference(position, a + stride, a);
    const Triple<Real> to_c = difference(position, a + stride + 1, a);
    const Triple<Real> to_d = difference(position, a + 1, a);
    const Triple<Real> n1 = cross(to_b, to_c), n2 = cross(to_c, to_d), n3 = cross(to_b, to_d);
    force.x[a] += twelfth * (n1.x + n2.x + n3.x);
    force.y[a] += twelfth * (n1.y + n2.y + n3.y);
    force.z[a] += twelfth * (n1.z + n2.z + n3.z);
    force.x[a + stride] += twelfth * (2 * n1.x + n2.x);
    force.y[a + stride] += twelfth * (2 * n1.y + n2.y);
    force.z[a + stride] += twelfth * (2 * n1.z + n2.z);
    upper.x[c] = twelfth * (n1.x + 2 * n2.x);
    upper.y[c] = twelfth * (n1.y + 2 * n2.y);
    upper.z[c] = twelfth * (n1.z + 2 * n2.z);
    lower.x[c] = twelfth * (2 * (n1.x + n2.x) - n3.x);
    lower.y[c] = twelfth * (2 * (n1.y + n2.y) - n3.y);
    lower.z[c] = twelfth * (2 * (n1.z + n2.z) - n3.z);
  }
  const auto right = static_cast<std::size_t>(first + 1);
  add_rows(force + right, upper, count);
  add_rows(force + (right + static_cast<std::size_t>(stride)), lower, count);
}

template <class Real>
[[gnu::always_inline]] inline void add_all(const Grid& grid, const Components<const Real>& position,
                                           Real pressure, const Components<Real>& force, Real* work) {
  const std::ptrdiff_t stride = grid.stride;
  const Components<Real> upper{work, work + stride, work + 2 * stride};
  const Components<Real> lower = upper + 3 * static_cast<std::size_t>(stride);
  for (int r = 0; r + 1 < grid.rows; ++r) {
    add_cells<Real>(grid, position, pressure / 12, force, upper, lower, r * stride);
  }
}

}  // namespace

std::size_t pressure_work_size(const Grid& grid) { return 6 * static_cast<std::size_t>(grid.stride); }

WEFT_MULTIVERSION void add_pressure(const Grid& grid, Components<const float> position, float pressure,
                                    Components<float> force, float* work) {
  add_all<float>(grid, position, pressure, force, work);
}
WEFT_MULTIVERSION void add_pressure(const Grid& grid, Components<const double> position, double pressure,
                                    Components<double> force, double* work) {
  add_all<double>(grid, position, pressure, force, work);
}

}  // namespace weft::kernels
