#pragma once
#include <cmath>
#include <limits>

#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/spring_kernels.h"

/// How springs are damped row by row; for kernels' .cpp files only.
namespace weft::kernels::strain_damping_rows {

template <class Real>
struct Fields {
  Components<const Real> position, change;
  Components<Real> force;
  Components<Real> work;  ///< a row: forces on the springs' first ends
};

/// What is damped: what the ends' velocities make of the length, the same of springs beyond their limits
/// alone, or what the ends' ways to the position have made of it.
enum class Damped { rate, rate_beyond_limits, growth };

/// Springs of one family that begin in one row, at the columns [begin, end); `first` is where the row begins,
/// `other` where their second ends lie from the first.
template <class Real, Damped kDamped>
[[gnu::always_inline]] inline void add_row(const SpringColumns<Real>& springs, Real factor,
                                           const Fields<Real>& fields, std::ptrdiff_t first,
                                           std::ptrdiff_t other, int begin, int end) {
  const Real* __restrict stiffness = springs.stiffness;
  const Real limit_length = springs.limit_length;
  const Real* __restrict x = fields.position.x + first;
  const Real* __restrict y = fields.position.y + first;
  const Real* __restrict z = fields.position.z + first;
  const Real* __restrict ux = fields.change.x + first;
  const Real* __restrict uy = fields.change.y + first;
  const Real* __restrict uz = fields.change.z + first;
  const Components<Real> work = fields.work;
  const Components<Real> force = fields.force + static_cast<std::size_t>(first);
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = begin; c < end; ++c) {
    const Real dx = x[c] - x[c + other], dy = y[c] - y[c + other], dz = z[c] - z[c + other];
    // Coincident ends have no direction: d is zero, and this keeps the factor before it finite.
    const Real squared = dx * dx + dy * dy + dz * dz + std::numeric_limits<Real>::min();
    const Real wx = ux[c] - ux[c + other], wy = uy[c] - uy[c + other], wz = uz[c] - uz[c + other];
    const Real rate = dx * wx + dy * wy + dz * wz;
    Real along = -factor * stiffness[c] * (rate / squared);
    if constexpr (kDamped == Damped::growth) {
      // |d| - |d - w| without a difference of near equals.
      const Real bx = dx - wx, by = dy - wy, bz = dz - wz, length = std::sqrt(squared);
      const Real began = std::sqrt(bx * bx + by * by + bz * bz);
      const Real growth = (2 * rate - (wx * wx + wy * wy + wz * wz)) / (length + began);
      along = -factor * stiffness[c] * (growth / length);
    }
    if constexpr (kDamped == Damped::rate_beyond_limits) {
      const Real past = std::sqrt(squared) - limit_length;
      along *= unit_step(past, (past + std::abs(past)) / 2);
    }
    work.x[c] = along * dx;
    work.y[c] = along * dy;
    work.z[c] = along * dz;
  }
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = begin; c < end; ++c) {
    force.x[c] += work.x[c];
    force.y[c] += work.y[c];
    force.z[c] += work.z[c];
  }
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = begin; c < end; ++c) {
    force.x[c + other] -= work.x[c];
    force.y[c + other] -= work.y[c];
    force.z[c + other] -= work.z[c];
  }
}

template <class Real, Damped kDamped, bool kTorn>
[[gnu::always_inline]] inline void add_all(const SpringLattice<Real>& springs, const Grid& grid, Real factor,
                                           const Fields<Real>& fields) {
  const std::ptrdiff_t stride = grid.stride;
  for (int r = 0; r < grid.rows; ++r) {
    const std::ptrdiff_t first = r * stride;
    const bool last = r + 1 == grid.rows;
    const Real share = r == 0 || last ? springs.border_row_share * factor : factor;
    const SpringLattice<Real>& own = springs_of_row<kTorn>(springs, r);
    add_row<Real, kDamped>(own.along_u, share, fields, first, 1, 0, grid.cols - 1);
    if (kDamped != Damped::rate_beyond_limits && springs.has_bending) {
      add_row<Real, kDamped>(own.bending_u, share, fields, first, 2, 0, grid.cols - 2);
      if (r + 2 < grid.rows)
        add_row<Real, kDamped>(own.bending_v, factor, fields, first, 2 * stride, 0, grid.cols);
    }
    if (last) break;
    add_row<Real, kDamped>(own.along_v, factor, fields, first, stride, 0, grid.cols);
    if (springs.has_shear) {
      add_row<Real, kDamped>(own.falling, factor, fields, first, stride + 1, 0, grid.cols - 1);
      add_row<Real, kDamped>(own.rising, factor, fields, first, stride - 1, 1, grid.cols);
    }
  }
}

template <class Real>
[[gnu::always_inline]] inline Components<Real> work_row(const Grid& grid, Real* work) {
  return {work, work + grid.stride, work + 2 * grid.stride};
}

}  // namespace weft::kernels::strain_damping_rows
