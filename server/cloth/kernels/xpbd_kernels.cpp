#include "cloth/kernels/xpbd_kernels.h"

#include <cstddef>

#include "cloth/kernels/xpbd_rows.h"

namespace weft::kernels {
namespace {

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
      width(xpbd_rows::round_up((grid.cols + 2) / 4, xpbd_rows::kGroup)),
      stride(static_cast<std::size_t>(xpbd_rows::round_up(4 * width + 1, kRowAlign))) {}

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
  xpbd_rows::sweep<xpbd_rows::Recall<float>, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void recall(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet) {
  xpbd_rows::sweep<xpbd_rows::Recall<double>, false>(layout, springs, sheet);
}

WEFT_MULTIVERSION void project(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet) {
  xpbd_rows::project<float, false, false>(layout, springs, sheet);
}
WEFT_MULTIVERSION void project(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet) {
  xpbd_rows::project<double, false, false>(layout, springs, sheet);
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
