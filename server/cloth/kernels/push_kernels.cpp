#include "cloth/kernels/push_kernels.h"

#include <cmath>
#include <limits>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

/// The wind at node i.
template <class Real>
[[gnu::always_inline]] inline Uniform<Real> air_at_node(const Uniform<Real>& air, std::size_t) {
  return air;
}
template <class Real>
[[gnu::always_inline]] inline Uniform<Real> air_at_node(const Components<const float>& air, std::size_t i) {
  return {air.x[i], air.y[i], air.z[i]};
}

template <class Real>
[[gnu::always_inline]] inline Real speed_of(const Uniform<Real>&, const Uniform<Real>&) {
  return Real(1);
}
template <class Real>
[[gnu::always_inline]] inline Real speed_of(const Components<const float>&, const Uniform<Real>& here) {
  return std::sqrt(here.x * here.x + here.y * here.y + here.z * here.z);
}

/// Row `r` of the nodes [begin, begin + count): tangents from the neighbours `left`, `right` columns and
/// `up`, `down` rows away.
template <class Real, class Air>
[[gnu::always_inline]] inline void normals_block(const Components<const Real>& p, std::size_t first,
                                                 int count, std::size_t left, std::size_t right,
                                                 std::size_t up, std::size_t down, const Air& air,
                                                 const Real* __restrict mass, const Push<Real>& push,
                                                 const Components<Real>& force) {
  const Real smallest = std::numeric_limits<Real>::min();
  Real* __restrict fx = force.x + first;
  Real* __restrict fy = force.y + first;
  Real* __restrict fz = force.z + first;
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    const std::size_t i = first + static_cast<std::size_t>(c);
    const Real ux = p.x[i + right] - p.x[i - left], uy = p.y[i + right] - p.y[i - left],
               uz = p.z[i + right] - p.z[i - left];
    const Real wx = p.x[i - up] - p.x[i + down], wy = p.y[i - up] - p.y[i + down],
               wz = p.z[i - up] - p.z[i + down];
    const Real nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
    const Real squared = nx * nx + ny * ny + nz * nz;
    const Uniform<Real> wind = air_at_node<Real>(air, i);
    const Real downwind = nx * wind.x + ny * wind.y + nz * wind.z;
    const Real strength = (push.per_node + push.per_mass * mass[i]) * speed_of(air, wind);
    const Real scale =
        (downwind < Real(0) ? -strength : strength) / std::sqrt(squared > smallest ? squared : smallest);
    fx[c] += scale * nx;
    fy[c] += scale * ny;
    fz[c] += scale * nz;
  }
}

template <class Real, class Air>
[[gnu::always_inline]] inline void add_normals(const Grid& grid, const Components<const Real>& p,
                                               const Real* mass, const Push<Real>& push, const Air& air,
                                               const Components<Real>& force) {
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int r = 0; r < grid.rows; ++r) {
    const std::size_t up = r > 0 ? stride : 0;
    const std::size_t down = r + 1 < grid.rows ? stride : 0;
    normals_block(p, grid.index(r, 0), 1, 0, 1, up, down, air, mass, push, force);
    normals_block(p, grid.index(r, 1), grid.cols - 2, 1, 1, up, down, air, mass, push, force);
    normals_block(p, grid.index(r, grid.cols - 1), 1, 1, 0, up, down, air, mass, push, force);
  }
}

template <class Real>
[[gnu::always_inline]] inline void push_row(Real* __restrict force, const Real* __restrict mass,
                                            const Push<Real>& push, Real wind, int count) {
  for (int c = 0; c < count; ++c) force[c] += (push.per_node + push.per_mass * mass[c]) * wind;
}

template <class Real>
[[gnu::always_inline]] inline void push_row(Real* __restrict force, const Real* __restrict mass,
                                            const Push<Real>& push, const float* wind, int count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) force[c] += (push.per_node + push.per_mass * mass[c]) * Real(wind[c]);
}

/// The wind along a row.
template <class Real>
[[gnu::always_inline]] inline const Uniform<Real>& in_row(const Uniform<Real>& air, std::size_t) {
  return air;
}
[[gnu::always_inline]] inline Components<const float> in_row(const Components<const float>& air,
                                                             std::size_t first) {
  return air + first;
}

template <class Real, class Air>
[[gnu::always_inline]] inline void push_all(const Grid& grid, const Real* mass, const Push<Real>& push,
                                            const Air& air, const Components<Real>& force) {
  for (int r = 0; r < grid.rows; ++r) {
    const std::size_t first = grid.index(r, 0);
    const Air wind = in_row(air, first);
    push_row(force.x + first, mass + first, push, wind.x, grid.cols);
    push_row(force.y + first, mass + first, push, wind.y, grid.cols);
    push_row(force.z + first, mass + first, push, wind.z, grid.cols);
  }
}

}  // namespace

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_PUSH_KERNELS(Real, Air)                                                                       \
  template <>                                                                                              \
  WEFT_MULTIVERSION void add_push(const Grid& grid, const Real* mass, const Push<Real>& push,              \
                                  const Air& wind, Components<Real> force) {                               \
    push_all<Real, Air>(grid, mass, push, wind, force);                                                    \
  }                                                                                                        \
  template <>                                                                                              \
  WEFT_MULTIVERSION void add_push_along_normals(const Grid& grid, Components<const Real> position,         \
                                                const Real* mass, const Push<Real>& push, const Air& wind, \
                                                Components<Real> force) {                                  \
    add_normals<Real, Air>(grid, position, mass, push, wind, force);                                       \
  }

WEFT_PUSH_KERNELS(float, Uniform<float>)
WEFT_PUSH_KERNELS(double, Uniform<double>)
WEFT_PUSH_KERNELS(float, Components<const float>)
WEFT_PUSH_KERNELS(double, Components<const float>)
#undef WEFT_PUSH_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
