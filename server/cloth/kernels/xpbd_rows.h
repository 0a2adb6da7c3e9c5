#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/xpbd_kernels.h"

/// How a family's springs are gone through colour by colour; for kernels' .cpp files only.
namespace weft::kernels::xpbd_rows {

inline constexpr int kGroup = 8;

constexpr int round_up(int n, int to) { return (n + to - 1) / to * to; }

/// A run of one family's springs: from lane a[i] to lane b[i], i < count. No lane is met twice.
template <class Real>
struct Run {
  Real *a, *b;
  const Real* __restrict stiffness;
  Real share;                   ///< of the stiffness
  Real* __restrict multiplier;  ///< of damped springs
  int count;
};

/// Projects the springs. Damped ones go on from the multipliers they begin with.
template <class Real, bool kRateDamped, bool kLimited>
struct Projection {
  static constexpr bool kDamped = kRateDamped;

  [[gnu::always_inline]] static void apply(const Run<Real>& run, const XpbdSprings<Real>& springs,
                                           std::size_t stride) {
    const Real rest_length = springs.rest_length, damping = springs.damping;
    const Real limit_length = springs.limit_length, excess = springs.excess;
    const Real* const stiffness = run.stiffness;
    Real* const multiplier = run.multiplier;
    const Real share = run.share;
    const Real *ax = run.a, *ay = ax + stride, *az = ay + stride;
    const Real *bx = run.b, *by = bx + stride, *bz = by + stride;
    Real *ux = run.a + QuarterRows::kMove * stride, *uy = ux + stride, *uz = uy + stride;
    Real *vx = run.b + QuarterRows::kMove * stride, *vy = vx + stride, *vz = vy + stride;
    const Real* wa = run.a + QuarterRows::kInverseMass * stride;
    const Real* wb = run.b + QuarterRows::kInverseMass * stride;
    WEFT_INDEPENDENT_ITERATIONS
    for (int i = 0; i < run.count; ++i) {
      const Real xa = ux[i], ya = uy[i], za = uz[i], ma = wa[i];
      const Real xb = vx[i], yb = vy[i], zb = vz[i], mb = wb[i];
      const Real dx = ax[i] - bx[i] + (xa - xb);
      const Real dy = ay[i] - by[i] + (ya - yb);
      const Real dz = az[i] - bz[i] + (za - zb);
      // Coincident ends have no direction: d is zero, and this keeps the factor before it finite.
      const Real smallest = std::numeric_limits<Real>::min();
      const Real squared = dx * dx + dy * dy + dz * dz;
      const Real length = std::sqrt(squared > smallest ? squared : smallest);
      const Real k = share * stiffness[i];
      Real shorter = rest_length - length, weight = ma + mb, begun = 0;
      if constexpr (kDamped) {
        shorter -= damping * (dx * (xa - xb) + dy * (ya - yb) + dz * (za - zb)) / length;
        weight *= Real(1) + damping;
        begun = multiplier[i];
      }
      Real factor = (k * shorter - begun) / (length * (Real(1) + k * weight));
      if constexpr (kLimited) {
        shorter -= excess * (length - limit_length);
        weight += excess * (ma + mb);
        const Real beyond = (k * shorter - begun) / (length * (Real(1) + k * weight));
        factor = beyond < factor ? beyond : factor;  // tension is negative here
      }
      if constexpr (kDamped) multiplier[i] += factor * length;
      const Real fa = factor * ma, fb = factor * mb;
      ux[i] = xa + fa * dx;
      uy[i] = ya + fa * dy;
      uz[i] = za + fa * dz;
      vx[i] = xb - fb * dx;
      vy[i] = yb - fb * dy;
      vz[i] = zb - fb * dz;
    }
  }
};

/// Begins the springs' multipliers anew from what is kept of their last.
template <class Real>
struct Recall {
  static constexpr bool kDamped = true;

  [[gnu::always_inline]] static void apply(const Run<Real>& run, const XpbdSprings<Real>& springs,
                                           std::size_t stride) {
    const Real kept = springs.damping / (Real(1) + springs.damping);
    Real* const multiplier = run.multiplier;
    const Real *ax = run.a, *ay = ax + stride, *az = ay + stride;
    const Real *bx = run.b, *by = bx + stride, *bz = by + stride;
    Real *ux = run.a + QuarterRows::kMove * stride, *uy = ux + stride, *uz = uy + stride;
    Real *vx = run.b + QuarterRows::kMove * stride, *vy = vx + stride, *vz = vy + stride;
    const Real* wa = run.a + QuarterRows::kInverseMass * stride;
    const Real* wb = run.b + QuarterRows::kInverseMass * stride;
    WEFT_INDEPENDENT_ITERATIONS
    for (int i = 0; i < run.count; ++i) {
      const Real xa = ux[i], ya = uy[i], za = uz[i];
      const Real xb = vx[i], yb = vy[i], zb = vz[i];
      const Real dx = ax[i] - bx[i] + (xa - xb);
      const Real dy = ay[i] - by[i] + (ya - yb);
      const Real dz = az[i] - bz[i] + (za - zb);
      const Real smallest = std::numeric_limits<Real>::min();
      const Real squared = dx * dx + dy * dy + dz * dz;
      // One that turns round or doubles meanwhile has nothing to keep: it would be pushed anywhere.
      const Real along = (ax[i] - bx[i]) * dx + (ay[i] - by[i]) * dy + (az[i] - bz[i]) * dz;
      const Real begun = along > Real(0.5) * squared ? kept * multiplier[i] : Real(0);
      const Real factor = begun / std::sqrt(squared > smallest ? squared : smallest);
      const Real fa = factor * wa[i], fb = factor * wb[i];
      multiplier[i] = begun;
      ux[i] = xa + fa * dx;
      uy[i] = ya + fa * dy;
      uz[i] = za + fa * dz;
      vx[i] = xb - fb * dx;
      vy[i] = yb - fb * dy;
      vz[i] = zb - fb * dz;
    }
  }
};

/// Applies a Kind to a family's runs, colour by colour. Springs within a row: two quarters of the columns
/// begin a spring of the first colour, two one of the second.
template <class Kind, bool kTorn, class Real>
[[gnu::always_inline]] inline void sweep_within_rows(const QuarterRows& layout,
                                                     const XpbdSprings<Real>& springs, Real* sheet) {
  for (int r = 0; r < layout.rows; ++r) {
    Real* row = sheet + static_cast<std::size_t>(r) * layout.row_size();
    const Real share = r == 0 || r == layout.rows - 1 ? springs.border_row_share : Real(1);
    const Real* const stiffness = kTorn ? springs.stiffness + r * springs.row_step : springs.stiffness;
    Real* const multiplier =
        Kind::kDamped ? springs.multiplier + static_cast<std::size_t>(r) * layout.stride : nullptr;
    for (int i = 0; i < 4; ++i) {
      const int col = springs.cols == 1 ? i / 2 + i % 2 * 2 : i;  // 0, 2 then 1, 3; or 0, 1 then 2, 3
      const int left = layout.lane(col), right = layout.lane(col + springs.cols);
      Kind::apply({row + left, row + right, stiffness + left, share,
                   Kind::kDamped ? multiplier + left : nullptr, layout.width},
                  springs, layout.stride);
    }
  }
}

/// Springs between rows: a row begins springs of one colour, the row at their other end of the other.
template <class Kind, bool kTorn, class Real>
[[gnu::always_inline]] inline void sweep_between_rows(const QuarterRows& layout,
                                                      const XpbdSprings<Real>& springs, Real* sheet) {
  const int across = springs.cols < 0 ? -springs.cols : springs.cols;
  for (int colour = 0; colour < 2; ++colour) {
    for (int r = 0; r + springs.rows < layout.rows; ++r) {
      if (r / springs.rows % 2 != colour) continue;
      Real* left = sheet + static_cast<std::size_t>(r) * layout.row_size();
      Real* right = left + static_cast<std::size_t>(springs.rows) * layout.row_size();
      if (springs.cols < 0) std::swap(left, right);
      const Real* const stiffness = kTorn ? springs.stiffness + r * springs.row_step : springs.stiffness;
      Real* const multiplier =
          Kind::kDamped ? springs.multiplier + static_cast<std::size_t>(r) * layout.stride : nullptr;
      if (across == 0) {
        Kind::apply({left, right, stiffness, Real(1), multiplier, round_up(4 * layout.width + 1, kGroup)},
                    springs, layout.stride);
      } else {
        for (int col = 0; col < 4; ++col) {
          const int from = layout.lane(col), to = layout.lane(col + across);
          Kind::apply({left + from, right + to, stiffness + from, Real(1),
                       Kind::kDamped ? multiplier + from : nullptr, layout.width},
                      springs, layout.stride);
        }
      }
    }
  }
}

template <class Kind, bool kTorn, class Real>
[[gnu::always_inline]] inline void sweep(const QuarterRows& layout, const XpbdSprings<Real>& springs,
                                         Real* sheet) {
  if (springs.rows == 0) {
    sweep_within_rows<Kind, kTorn>(layout, springs, sheet);
  } else {
    sweep_between_rows<Kind, kTorn>(layout, springs, sheet);
  }
}

template <class Real, bool kLimited, bool kTorn>
[[gnu::always_inline]] inline void project(const QuarterRows& layout, const XpbdSprings<Real>& springs,
                                           Real* sheet) {
  if (springs.damping > Real(0)) {
    sweep<Projection<Real, true, kLimited>, kTorn>(layout, springs, sheet);
  } else {
    sweep<Projection<Real, false, kLimited>, kTorn>(layout, springs, sheet);
  }
}

}  // namespace weft::kernels::xpbd_rows
