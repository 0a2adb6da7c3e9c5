#pragma once
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>

#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/spring_energy_kernels.h"

/// How springs' energies and their models' errors are added up row by row; for kernels' .cpp files only.
namespace weft::kernels::spring_energy_rows {

template <class Real>
struct Fields {
  Components<const Real> position, change;
};

/// Sums by lane, so that the order of additions is the same with every instruction set.
template <class Real>
struct Lanes {
  alignas(64) Real sum[kLinkGroup]{};
  alignas(64) Real magnitude[kLinkGroup]{};
  alignas(64) Real largest[kLinkGroup]{};
  alignas(64) Real struck[kLinkGroup]{};

  [[gnu::always_inline]] void flush(SpringModelError& error) {
    for (int lane = 0; lane < kLinkGroup; ++lane) {
      error.sum += static_cast<double>(sum[lane]);
      error.magnitude += static_cast<double>(magnitude[lane]);
      sum[lane] = magnitude[lane] = Real(0);
    }
  }
  [[gnu::always_inline]] void find_largest(SpringModelError& error) const {
    error.largest = static_cast<double>(*std::max_element(std::begin(largest), std::end(largest)));
    error.struck = static_cast<double>(*std::max_element(std::begin(struck), std::end(struck)));
  }
};

/// Springs of one family that start in one row; `other` is where their second ends lie from the first.
template <class Real, bool kLimited>
[[gnu::always_inline]] inline void add_row(const SpringColumns<Real>& springs, Real excess, Real share,
                                           const Fields<Real>& fields, std::ptrdiff_t first,
                                           std::ptrdiff_t other, int count, Lanes<Real>& lanes) {
  const Real* __restrict stiffness = springs.stiffness;
  const Real rest_length = springs.rest_length, limit_length = springs.limit_length;
  const Real* __restrict x = fields.position.x + first;
  const Real* __restrict y = fields.position.y + first;
  const Real* __restrict z = fields.position.z + first;
  const Real* __restrict ux = fields.change.x + first;
  const Real* __restrict uy = fields.change.y + first;
  const Real* __restrict uz = fields.change.z + first;
  for (int c = 0; c < count; c += kLinkGroup) {
    for (int lane = 0; lane < kLinkGroup; ++lane) {
      const std::ptrdiff_t i = c + lane;
      const Real dx = x[i] - x[i + other], dy = y[i] - y[i + other], dz = z[i] - z[i + other];
      const Real ex = ux[i] - ux[i + other], ey = uy[i] - uy[i + other], ez = uz[i] - uz[i + other];
      const Real length = std::sqrt(dx * dx + dy * dy + dz * dz + std::numeric_limits<Real>::min());
      const Real along = (dx * ex + dy * ey + dz * ez) / length;
      // The part of the change that turns the spring, squared; rounding may leave it below 0.
      const Real across = ex * ex + ey * ey + ez * ez - along * along;
      const Real turned = (across + std::abs(across)) / 2;
      const Real straight = length + along;
      const Real longer = std::sqrt(straight * straight + turned + std::numeric_limits<Real>::min());
      // The new length less `straight`, without a difference of near equals; below 0 the ends have passed
      // each other.
      const Real extra = turned / (longer + std::abs(straight)) + (std::abs(straight) - straight);
      const Real stretch = length - rest_length;
      const Real sideways = ((stretch + std::abs(stretch)) / 2) / length;
      Real twice = extra * (2 * (stretch + along) + extra) - sideways * turned;
      if constexpr (kLimited) {
        const Real past = length - limit_length, over = (past + std::abs(past)) / 2;
        const Real past_then = past + along + extra, found = (past_then + std::abs(past_then)) / 2;
        const Real is_over = unit_step(past, over), reckoned = over + is_over * along;
        // Beyond the limit before and after: again without a difference of near equals.
        const Real stays = is_over * unit_step(past_then, found);
        const Real gain = stays * extra + (1 - stays) * (found - reckoned);
        twice += excess * (gain * (found + reckoned) - over / length * turned);
        const Real there = unit_step(stiffness[i], stiffness[i]);  // 0 where there is no spring
        lanes.struck[lane] = std::max(lanes.struck[lane], there * (1 - is_over) * found / rest_length);
      }
      const Real error = share * stiffness[i] / 2 * twice;
      lanes.sum[lane] += error;
      lanes.magnitude[lane] += std::abs(error);
      lanes.largest[lane] = std::max(lanes.largest[lane], std::abs(error));
    }
  }
}

/// Calls add(family, limited, share of the stiffness, first end's place, second end's from it) for each
/// family's springs row by row, and end_row() after each row.
template <bool kTorn, class Real, class Add, class EndRow>
[[gnu::always_inline]] inline void for_each_row(const SpringLattice<Real>& springs, const Grid& grid, Add add,
                                                EndRow end_row) {
  const std::ptrdiff_t stride = grid.stride;
  for (int r = 0; r < grid.rows; ++r) {
    const std::ptrdiff_t first = r * stride;
    const bool last = r + 1 == grid.rows;
    const Real share = r == 0 || last ? springs.border_row_share : Real(1);
    const SpringLattice<Real>& own = springs_of_row<kTorn>(springs, r);
    add(own.along_u, std::true_type{}, share, first, 1);
    if (springs.has_bending) {
      add(own.bending_u, std::false_type{}, share, first, 2);
      if (r + 2 < grid.rows) add(own.bending_v, std::false_type{}, Real(1), first, 2 * stride);
    }
    if (!last) {
      add(own.along_v, std::true_type{}, Real(1), first, stride);
      if (springs.has_shear) {
        add(own.falling, std::true_type{}, Real(1), first, stride + 1);
        add(own.rising, std::true_type{}, Real(1), first, stride - 1);
      }
    }
    end_row();
  }
}

template <class Real, bool kLimited, bool kTorn>
[[gnu::always_inline]] inline SpringModelError model_error(const SpringLattice<Real>& springs,
                                                           const Grid& grid, const Fields<Real>& fields) {
  SpringModelError error;
  Lanes<Real> lanes;
  const int count = grouped(grid.cols);
  for_each_row<kTorn>(
      springs, grid,
      [&](const SpringColumns<Real>& family, auto limited, Real share, std::ptrdiff_t first,
          std::ptrdiff_t other) WEFT_INLINE_LAMBDA {
        constexpr bool kLimits = kLimited && decltype(limited)::value;
        add_row<Real, kLimits>(family, springs.excess, share, fields, first, other, count, lanes);
      },
      [&]() WEFT_INLINE_LAMBDA { lanes.flush(error); });
  lanes.find_largest(error);
  return error;
}

/// Springs of one family that start in one row, at `position`; `excess` is 0 of those without limits.
template <class Real>
struct EnergyRow {
  const Real* __restrict stiffness;
  const Real* __restrict x;
  const Real* __restrict y;
  const Real* __restrict z;
  std::ptrdiff_t other;
  Real rest_length, limit_length, excess;

  /// Of the spring that starts in this column.
  [[gnu::always_inline]] Real twice_energy(int c) const {
    const Real dx = x[c] - x[c + other], dy = y[c] - y[c + other], dz = z[c] - z[c + other];
    const Real length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const Real stretch = length - rest_length, past = length - limit_length;
    const Real over = (past + std::abs(past)) / 2;
    return stiffness[c] * (stretch * stretch + excess * over * over);
  }
};

/// Added up in lanes, so that the order of additions is the same with every instruction set.
template <class Real>
[[gnu::always_inline]] inline double energy(const SpringLattice<Real>& springs, const Grid& grid,
                                            Components<const Real> position) {
  constexpr int kLanes = kLinkGroup;
  alignas(64) Real row[kLanes]{};
  alignas(64) double lanes[kLanes]{};
  const int cols = grid.cols;
  for_each_row<true>(
      springs, grid,
      [&](const SpringColumns<Real>& family, auto limited, Real share, std::ptrdiff_t first,
          std::ptrdiff_t other) WEFT_INLINE_LAMBDA {
        const EnergyRow<Real> own{family.stiffness,
                                  position.x + first,
                                  position.y + first,
                                  position.z + first,
                                  other,
                                  family.rest_length,
                                  family.limit_length,
                                  decltype(limited)::value ? springs.excess : Real(0)};
        int c = 0;
        for (; c + kLanes <= cols; c += kLanes) {
          for (int lane = 0; lane < kLanes; ++lane) row[lane] += share / 2 * own.twice_energy(c + lane);
        }
        // Not in a whole group: beyond the last row's end nothing may be read.
        for (; c < cols; ++c) row[c % kLanes] += share / 2 * own.twice_energy(c);
      },
      [&]() WEFT_INLINE_LAMBDA {
        for (int lane = 0; lane < kLanes; ++lane) {
          lanes[lane] += static_cast<double>(row[lane]);
          row[lane] = Real(0);
        }
      });
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  return sum;
}

}  // namespace weft::kernels::spring_energy_rows
