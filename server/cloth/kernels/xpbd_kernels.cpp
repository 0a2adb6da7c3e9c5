#include "cloth/kernels/xpbd_kernels.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "cloth/multiversion.h"

namespace weft::kernels {
namespace {

constexpr int kGroup = 8;

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
[[gnu::always_inline]] inline void project_any(const QuarterRows& layout, const XpbdSprings<Real>& springs,
                                               Real* sheet) {
  if (springs.damping > Real(0)) {
    sweep<Projection<Real, true, kLimited>, kTorn>(layout, springs, sheet);
  } else {
    sweep<Projection<Real, false, kLimited>, kTorn>(layout, springs, sheet);
  }
}

/// Columns 4j to 4j + 3 for j < groups(cols), and the last column where it is left over.
std::ptrdiff_t groups(int cols) { return (cols + 2) / 4; }

template <class Real>
[[gnu::always_inline]] inline void to_lanes(const QuarterRows& layout, const Real* __restrict row,
                                            Real* __restrict lanes) {
  const std::ptrdiff_t count = groups(layout.cols);
  Real *lanes0 = lanes + layout.lane(0), *lanes1 = lanes + layout.lane(1);
  Real *lanes2 = lanes + layout.lane(2), *lanes3 = lanes + layout.lane(3);
  WEFT_INDEPENDENT_ITERATIONS
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    lanes0[j] = row[4 * j];
    lanes1[j] = row[4 * j + 1];
    lanes2[j] = row[4 * j + 2];
    lanes3[j] = row[4 * j + 3];
  }
  if (4 * count < layout.cols) lanes0[count] = row[4 * count];
}

template <class Real>
[[gnu::always_inline]] inline void from_lanes(const QuarterRows& layout, const Real* __restrict lanes,
                                              Real* __restrict row) {
  const std::ptrdiff_t count = groups(layout.cols);
  const Real *lanes0 = lanes + layout.lane(0), *lanes1 = lanes + layout.lane(1);
  const Real *lanes2 = lanes + layout.lane(2), *lanes3 = lanes + layout.lane(3);
  WEFT_INDEPENDENT_ITERATIONS
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    row[4 * j] = lanes0[j];
    row[4 * j + 1] = lanes1[j];
    row[4 * j + 2] = lanes2[j];
    row[4 * j + 3] = lanes3[j];
  }
  if (4 * count < layout.cols) row[4 * count] = lanes0[count];
}

template <class Real>
[[gnu::always_inline]] inline void set_inverse_masses_any(const QuarterRows& layout, const Grid& grid,
                                                          const Real* inverse_mass, Real* sheet) {
  for (int r = 0; r < grid.rows; ++r) {
    to_lanes(
        layout, inverse_mass + grid.index(r, 0),
        sheet + static_cast<std::size_t>(r) * layout.row_size() + QuarterRows::kInverseMass * layout.stride);
  }
}

/// One component of one row.
template <class Real>
struct RowComponent {
  Real* __restrict velocity;
  Real* __restrict position;
  Real* __restrict rounded_off;

  RowComponent(const XpbdNodes<Real>& nodes, Real* Components<Real>::*component, std::size_t at)
      : velocity(nodes.velocity.*component + at),
        position(nodes.position.*component + at),
        rounded_off(nodes.rounded_off.*component + at) {}
};

/// `move` is work space of a row.
template <class Real>
[[gnu::always_inline]] inline void predict_row(const QuarterRows& layout, const RowComponent<Real>& nodes,
                                               const Real* __restrict force,
                                               const Real* __restrict inverse_mass, Real impulse_time, Real h,
                                               Real* lanes, Real* __restrict move) {
  for (int c = 0; c < layout.cols; ++c) {
    const bool free = inverse_mass[c] > Real(0);
    const Real v = free ? nodes.velocity[c] + force[c] * inverse_mass[c] * impulse_time : Real(0);
    nodes.velocity[c] = v;
    nodes.rounded_off[c] = free ? nodes.rounded_off[c] : Real(0);
    move[c] = nodes.rounded_off[c] + v * h;
  }
  to_lanes<Real>(layout, nodes.position, lanes);
  to_lanes<Real>(layout, move, lanes + QuarterRows::kMove * layout.stride);
}

template <class Real>
[[gnu::always_inline]] inline void predict_any(const QuarterRows& layout, const Grid& grid,
                                               const XpbdNodes<Real>& nodes, Real impulse_time, Real h,
                                               Real* sheet, Real* row) {
  for (int r = 0; r < grid.rows; ++r) {
    const std::size_t at = grid.index(r, 0);
    const Real* inverse_mass = nodes.inverse_mass + at;
    Real* lanes = sheet + static_cast<std::size_t>(r) * layout.row_size();
    predict_row<Real>(layout, {nodes, &Components<Real>::x, at}, nodes.force.x + at, inverse_mass,
                      impulse_time, h, lanes, row);
    predict_row<Real>(layout, {nodes, &Components<Real>::y, at}, nodes.force.y + at, inverse_mass,
                      impulse_time, h, lanes + layout.stride, row);
    predict_row<Real>(layout, {nodes, &Components<Real>::z, at}, nodes.force.z + at, inverse_mass,
                      impulse_time, h, lanes + 2 * layout.stride, row);
  }
}

/// `move` is work space of a row.
template <class Real>
[[gnu::always_inline]] inline void take_over_row(const QuarterRows& layout, const RowComponent<Real>& nodes,
                                                 const Real* lanes, Real h, Real* __restrict move) {
  from_lanes(layout, lanes + QuarterRows::kMove * layout.stride, move);
  const Real rate = Real(1) / h;
  for (int c = 0; c < layout.cols; ++c) {
    const Real before = nodes.position[c], predicted = nodes.rounded_off[c] + nodes.velocity[c] * h;
    const Real after = before + move[c];
    nodes.velocity[c] += (move[c] - predicted) * rate;
    nodes.rounded_off[c] = move[c] - (after - before);
    nodes.position[c] = after;
  }
}

template <class Real>
[[gnu::always_inline]] inline void take_over_any(const QuarterRows& layout, const Grid& grid,
                                                 const Real* sheet, Real h, const XpbdNodes<Real>& nodes,
                                                 Real* row) {
  for (int r = 0; r < grid.rows; ++r) {
    const Real* lanes = sheet + static_cast<std::size_t>(r) * layout.row_size();
    const std::size_t at = grid.index(r, 0);
    take_over_row<Real>(layout, {nodes, &Components<Real>::x, at}, lanes, h, row);
    take_over_row<Real>(layout, {nodes, &Components<Real>::y, at}, lanes + layout.stride, h, row);
    take_over_row<Real>(layout, {nodes, &Components<Real>::z, at}, lanes + 2 * layout.stride, h, row);
  }
}

}  // namespace

QuarterRows::QuarterRows(const Grid& grid)
    : rows(grid.rows),
      cols(grid.cols),
      width(round_up((grid.cols + 2) / 4, kGroup)),
      stride(static_cast<std::size_t>(round_up(4 * width + 1, kRowAlign))) {}

WEFT_MULTIVERSION void set_inverse_masses(const QuarterRows& layout, const Grid& grid,
                                          const float* inverse_mass, float* sheet) {
  set_inverse_masses_any(layout, grid, inverse_mass, sheet);
}
WEFT_MULTIVERSION void set_inverse_masses(const QuarterRows& layout, const Grid& grid,
                                          const double* inverse_mass, double* sheet) {
  set_inverse_masses_any(layout, grid, inverse_mass, sheet);
}

WEFT_MULTIVERSION void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<float>& nodes,
                               float impulse_time, float h, float* sheet, float* row) {
  predict_any(layout, grid, nodes, impulse_time, h, sheet, row);
}
WEFT_MULTIVERSION void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<double>& nodes,
                               double impulse_time, double h, double* sheet, double* row) {
  predict_any(layout, grid, nodes, impulse_time, h, sheet, row);
}

WEFT_MULTIVERSION void recall(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet) {
  sweep<Recall<float>, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void recall(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet) {
  sweep<Recall<double>, false>(layout, springs, sheet);
}

WEFT_MULTIVERSION void project(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet) {
  project_any<float, false, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project_limited(const QuarterRows& layout, const XpbdSprings<float>& springs,
                                       float* sheet) {
  project_any<float, true, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet) {
  project_any<double, false, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project_limited(const QuarterRows& layout, const XpbdSprings<double>& springs,
                                       double* sheet) {
  project_any<double, true, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project_torn(const QuarterRows& layout, const XpbdSprings<float>& springs,
                                    float* sheet) {
  project_any<float, true, true>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project_torn(const QuarterRows& layout, const XpbdSprings<double>& springs,
                                    double* sheet) {
  project_any<double, true, true>(layout, springs, sheet);
}

WEFT_MULTIVERSION void take_over(const QuarterRows& layout, const Grid& grid, const float* sheet, float h,
                                 const XpbdNodes<float>& nodes, float* row) {
  take_over_any(layout, grid, sheet, h, nodes, row);
}
WEFT_MULTIVERSION void take_over(const QuarterRows& layout, const Grid& grid, const double* sheet, double h,
                                 const XpbdNodes<double>& nodes, double* row) {
  take_over_any(layout, grid, sheet, h, nodes, row);
}

}  // namespace weft::kernels
