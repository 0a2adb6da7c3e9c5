#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/spring_kernels.h"

/// How spring forces go through a grid; for kernels' .cpp files only.
namespace weft::kernels::spring_rows {

/// Rows are handled in whole groups of so many scalars, so that no remainder is left to a scalar loop.
inline constexpr int kGroup = 8;
/// Zeros kept before and after each work row: a neighbour's neighbour is at most two columns away.
inline constexpr std::size_t kMargin = kRowAlign;
/// Work rows: the forces of four families, three components each, then one of zeros and three to be written
/// in vain.
inline constexpr std::size_t kWorkRows = 16;

inline std::size_t work_row_size(const Grid& grid) {
  return static_cast<std::size_t>(grid.stride) + 2 * kMargin;
}

template <class Real>
struct Force {
  Real x, y, z;
};

/// What the springs of a family have in common.
template <class Real>
struct Law {
  Real rest_length, limit_length, excess;
};

/// Force on end i of a spring, d = r_i - r_j: Eq. 1's summand.
template <bool kLimited, class Real>
[[gnu::always_inline]] inline Force<Real> spring(Real dx, Real dy, Real dz, Real stiffness,
                                                 const Law<Real>& law) {
  // Coincident ends have no direction: d is zero, and this keeps the factor before it finite.
  const Real smallest = std::numeric_limits<Real>::min();
  const Real squared = dx * dx + dy * dy + dz * dz;
  const Real length = std::sqrt(squared > smallest ? squared : smallest);
  Real shorter = law.rest_length - length;
  if constexpr (kLimited) {
    const Real over = length - law.limit_length;
    shorter -= law.excess * (over > Real(0) ? over : Real(0));
  }
  const Real factor = stiffness * shorter / length;
  return {factor * dx, factor * dy, factor * dz};
}

/// What one row of springs reads and writes: the row of their first ends, and the two rows below.
template <class Real>
struct Rows {
  Components<const Real> position0, position1, position2;
  Components<Real> force0, force1, force2;
  Components<Real> along, second, falling,
      rising;      ///< work rows: forces of springs whose ends lie in different columns
  Real row_share;  ///< of the springs within the row
};

/// Adds the forces of all springs whose first end lies in row 0 of `rows`. Springs down a column give their
/// force to both ends at once. For the others the second end is in another column, so that their forces wait
/// in work rows until the first pass is over.
template <class Real, bool kShear, bool kBending, bool kLimited>
[[gnu::always_inline]] inline void add_row(const SpringLattice<Real>& springs, const Rows<Real>& rows,
                                           const Real* __restrict stiffness_v,
                                           const Real* __restrict stiffness_falling,
                                           const Real* __restrict stiffness_rising,
                                           const Real* __restrict stiffness_bending_v, int count) {
  const Real* __restrict x0 = rows.position0.x;
  const Real* __restrict y0 = rows.position0.y;
  const Real* __restrict z0 = rows.position0.z;
  const Real* __restrict x1 = rows.position1.x;
  const Real* __restrict y1 = rows.position1.y;
  const Real* __restrict z1 = rows.position1.z;
  const Real* __restrict x2 = rows.position2.x;
  const Real* __restrict y2 = rows.position2.y;
  const Real* __restrict z2 = rows.position2.z;
  const Components<Real> f0 = rows.force0, f1 = rows.force1, f2 = rows.force2;
  const Components<Real> along = rows.along, second = rows.second, falling = rows.falling,
                         rising = rows.rising;
  const Real* __restrict stiffness_u = springs.along_u.stiffness;
  const Real* __restrict stiffness_bending_u = springs.bending_u.stiffness;
  const auto law_of = [&](const SpringColumns<Real>& family) WEFT_INLINE_LAMBDA -> Law<Real> {
    return {family.rest_length, family.limit_length, springs.excess};
  };
  const Law<Real> law_u = law_of(springs.along_u), law_v = law_of(springs.along_v);
  const Law<Real> law_shear = law_of(springs.falling);
  const Law<Real> law_bending_u = law_of(springs.bending_u), law_bending_v = law_of(springs.bending_v);
  const Real share = rows.row_share;

  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    const Real x = x0[c], y = y0[c], z = z0[c];
    Force<Real> sum =
        spring<kLimited>(x - x0[c + 1], y - y0[c + 1], z - z0[c + 1], share * stiffness_u[c], law_u);
    along.x[c] = sum.x;
    along.y[c] = sum.y;
    along.z[c] = sum.z;
    const Force<Real> v = spring<kLimited>(x - x1[c], y - y1[c], z - z1[c], stiffness_v[c], law_v);
    f1.x[c] -= v.x;
    f1.y[c] -= v.y;
    f1.z[c] -= v.z;
    sum = {sum.x + v.x, sum.y + v.y, sum.z + v.z};
    if constexpr (kShear) {
      const Force<Real> a =
          spring<kLimited>(x - x1[c + 1], y - y1[c + 1], z - z1[c + 1], stiffness_falling[c], law_shear);
      falling.x[c] = a.x;
      falling.y[c] = a.y;
      falling.z[c] = a.z;
      const Force<Real> b =
          spring<kLimited>(x - x1[c - 1], y - y1[c - 1], z - z1[c - 1], stiffness_rising[c], law_shear);
      rising.x[c] = b.x;
      rising.y[c] = b.y;
      rising.z[c] = b.z;
      sum = {sum.x + (a.x + b.x), sum.y + (a.y + b.y), sum.z + (a.z + b.z)};
    }
    if constexpr (kBending) {
      const Force<Real> a = spring<false>(x - x0[c + 2], y - y0[c + 2], z - z0[c + 2],
                                          share * stiffness_bending_u[c], law_bending_u);
      second.x[c] = a.x;
      second.y[c] = a.y;
      second.z[c] = a.z;
      const Force<Real> b =
          spring<false>(x - x2[c], y - y2[c], z - z2[c], stiffness_bending_v[c], law_bending_v);
      f2.x[c] -= b.x;
      f2.y[c] -= b.y;
      f2.z[c] -= b.z;
      sum = {sum.x + (a.x + b.x), sum.y + (a.y + b.y), sum.z + (a.z + b.z)};
    }
    f0.x[c] += sum.x;
    f0.y[c] += sum.y;
    f0.z[c] += sum.z;
  }
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    if constexpr (kBending) {
      f0.x[c] -= along.x[c - 1] + second.x[c - 2];
      f0.y[c] -= along.y[c - 1] + second.y[c - 2];
      f0.z[c] -= along.z[c - 1] + second.z[c - 2];
    } else {
      f0.x[c] -= along.x[c - 1];
      f0.y[c] -= along.y[c - 1];
      f0.z[c] -= along.z[c - 1];
    }
    if constexpr (kShear) {
      f1.x[c] -= falling.x[c - 1] + rising.x[c + 1];
      f1.y[c] -= falling.y[c - 1] + rising.y[c + 1];
      f1.z[c] -= falling.z[c - 1] + rising.z[c + 1];
    }
  }
}

template <class T>
[[gnu::always_inline]] inline Components<T> offset(const Components<T>& field, std::size_t by) {
  return {field.x + by, field.y + by, field.z + by};
}

template <class Real, bool kShear, bool kBending, bool kLimited, bool kTorn>
[[gnu::always_inline]] inline void add_all_rows(const SpringLattice<Real>& springs, const Grid& grid,
                                                const Components<const Real>& position,
                                                const Components<Real>& force, Real* work) {
  const std::size_t work_row = work_row_size(grid);
  const auto work_field = [&](std::size_t first) -> Components<Real> {
    Real* row = work + kMargin + first * work_row;
    return {row, row + work_row, row + 2 * work_row};
  };
  Rows<Real> rows{};
  rows.along = work_field(0);
  rows.second = work_field(3);
  rows.falling = work_field(6);
  rows.rising = work_field(9);
  // Below the last row there are zeros: springs of no stiffness to nodes at the origin, whose forces go
  // nowhere.
  const Components<Real> nowhere = work_field(12);
  const Real* zeros = work + kMargin + 15 * work_row;
  const int count = std::min((grid.cols + kGroup - 1) / kGroup * kGroup, grid.stride - kRowPadding);
  for (int r = 0; r < grid.rows; ++r) {
    const bool has_next = r + 1 < grid.rows, has_second = r + 2 < grid.rows;
    rows.position0 = offset(position, grid.index(r, 0));
    rows.force0 = offset(force, grid.index(r, 0));
    rows.position1 =
        has_next ? offset(position, grid.index(r + 1, 0)) : Components<const Real>{zeros, zeros, zeros};
    rows.force1 = has_next ? offset(force, grid.index(r + 1, 0)) : nowhere;
    rows.position2 =
        has_second ? offset(position, grid.index(r + 2, 0)) : Components<const Real>{zeros, zeros, zeros};
    rows.force2 = has_second ? offset(force, grid.index(r + 2, 0)) : nowhere;
    rows.row_share = r == 0 || !has_next ? springs.border_row_share : Real(1);
    const SpringLattice<Real>& own = springs_of_row<kTorn>(springs, r);
    add_row<Real, kShear, kBending, kLimited>(
        own, rows, has_next ? own.along_v.stiffness : zeros, has_next ? own.falling.stiffness : zeros,
        has_next ? own.rising.stiffness : zeros, has_second ? own.bending_v.stiffness : zeros, count);
  }
}

template <class Real, bool kLimited>
[[gnu::always_inline]] inline void add_all(const SpringLattice<Real>& springs, const Grid& grid,
                                           const Components<const Real>& position,
                                           const Components<Real>& force, Real* work) {
  if (springs.has_shear && springs.has_bending) {
    add_all_rows<Real, true, true, kLimited, false>(springs, grid, position, force, work);
  } else if (springs.has_shear) {
    add_all_rows<Real, true, false, kLimited, false>(springs, grid, position, force, work);
  } else if (springs.has_bending) {
    add_all_rows<Real, false, true, kLimited, false>(springs, grid, position, force, work);
  } else {
    add_all_rows<Real, false, false, kLimited, false>(springs, grid, position, force, work);
  }
}

}  // namespace weft::kernels::spring_rows
