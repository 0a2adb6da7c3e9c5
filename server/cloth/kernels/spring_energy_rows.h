#pragma once
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "cloth/kernels/link_rows.h"
#include "cloth/kernels/spring_energy_kernels.h"

/// How springs' model errors are added up row by row; for kernels' .cpp files only.
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

template <class Real, bool kLimited, bool kTorn>
[[gnu::always_inline]] inline SpringModelError model_error(const SpringLattice<Real>& springs,
                                                           const Grid& grid, const Fields<Real>& fields) {
  SpringModelError error;
  Lanes<Real> lanes;
  const std::ptrdiff_t stride = grid.stride;
  const int count = grouped(grid.cols);
  for (int r = 0; r < grid.rows; ++r) {
    const std::ptrdiff_t first = r * stride;
    const bool last = r + 1 == grid.rows;
    const Real share = r == 0 || last ? springs.border_row_share : Real(1);
    const SpringLattice<Real>& own = springs_of_row<kTorn>(springs, r);
    const auto row = [&](const SpringColumns<Real>& family, Real row_share,
                         std::ptrdiff_t other) WEFT_INLINE_LAMBDA {
      add_row<Real, kLimited>(family, springs.excess, row_share, fields, first, other, count, lanes);
    };
    const auto bending_row = [&](const SpringColumns<Real>& family, Real row_share,
                                 std::ptrdiff_t other) WEFT_INLINE_LAMBDA {
      add_row<Real, false>(family, 0, row_share, fields, first, other, count, lanes);
    };
    row(own.along_u, share, 1);
    if (springs.has_bending) {
      bending_row(own.bending_u, share, 2);
      if (r + 2 < grid.rows) bending_row(own.bending_v, Real(1), 2 * stride);
    }
    if (!last) {
      row(own.along_v, Real(1), stride);
      if (springs.has_shear) {
        row(own.falling, Real(1), stride + 1);
        row(own.rising, Real(1), stride - 1);
      }
    }
    lanes.flush(error);
  }
  lanes.find_largest(error);
  return error;
}

}  // namespace weft::kernels::spring_energy_rows
