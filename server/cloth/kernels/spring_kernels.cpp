#include "cloth/kernels/spring_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cloth/multiversion.h"

namespace weft::kernels {
namespace {

/// Springs handled at a time: their forces stay in the first-level cache between the passes.
constexpr int kBlock = 128;
/// Rows are handled in whole groups of this many scalars where the padding allows it, so that no remainder is
/// left to a scalar loop.
constexpr int kGroup = 8;

/// The springs of one family between two rows.
struct SpringRow {
  std::size_t first;   ///< index of the first spring's end i
  std::size_t second;  ///< index of its end j
  int count;           ///< springs
  int padded;          ///< springs computed, count <= padded; those beyond count are discarded
  double share;        ///< of the family's stiffness, of all
  double end_share;    ///< of that, of the first and of the last spring
};

/// Forces on ends i of springs [begin, begin + count) of a row: Eq. 1's summand.
template <class Real>
[[gnu::always_inline]] inline void spring_block(const Real* __restrict xi, const Real* __restrict yi,
                                                const Real* __restrict zi, const Real* __restrict xj,
                                                const Real* __restrict yj, const Real* __restrict zj,
                                                int count, Real stiffness, Real rest_length,
                                                Real* __restrict fx, Real* __restrict fy,
                                                Real* __restrict fz) {
  // Coincident ends have no direction: d is zero, and this keeps the factor before it finite.
  const Real smallest = std::numeric_limits<Real>::min();
  for (int c = 0; c < count; ++c) {
    const Real dx = xi[c] - xj[c];
    const Real dy = yi[c] - yj[c];
    const Real dz = zi[c] - zj[c];
    const Real squared = dx * dx + dy * dy + dz * dz;
    const Real length = std::sqrt(squared > smallest ? squared : smallest);
    const Real factor = stiffness * (rest_length - length) / length;
    fx[c] = factor * dx;
    fy[c] = factor * dy;
    fz[c] = factor * dz;
  }
}

template <class Real>
[[gnu::always_inline]] inline void add_block(Real* __restrict target, const Real* __restrict block,
                                             int count) {
  for (int c = 0; c < count; ++c) target[c] += block[c];
}

template <class Real>
[[gnu::always_inline]] inline void subtract_block(Real* __restrict target, const Real* __restrict block,
                                                  int count) {
  for (int c = 0; c < count; ++c) target[c] -= block[c];
}

template <class Real>
[[gnu::always_inline]] inline void add_row(const SpringFamily& family, const SpringRow& row,
                                           const Components<const Real>& position,
                                           const Components<Real>& force) {
  alignas(64) Real fx[kBlock];
  alignas(64) Real fy[kBlock];
  alignas(64) Real fz[kBlock];
  const Real stiffness = static_cast<Real>(family.stiffness * row.share);
  const Real rest_length = static_cast<Real>(family.rest_length);
  const Real end_share = static_cast<Real>(row.end_share);
  for (int begin = 0; begin < row.padded; begin += kBlock) {
    const int count = std::min(kBlock, row.padded - begin);
    const std::size_t i = row.first + static_cast<std::size_t>(begin);
    const std::size_t j = row.second + static_cast<std::size_t>(begin);
    spring_block(position.x + i, position.y + i, position.z + i, position.x + j, position.y + j,
                 position.z + j, count, stiffness, rest_length, fx, fy, fz);
    if (begin == 0) {
      fx[0] *= end_share;
      fy[0] *= end_share;
      fz[0] *= end_share;
    }
    const int last = row.count - 1 - begin;
    if (last >= 0 && last < count) {
      fx[last] *= end_share;
      fy[last] *= end_share;
      fz[last] *= end_share;
    }
    for (int c = std::max(0, last + 1); c < count; ++c) fx[c] = fy[c] = fz[c] = Real(0);
    // One pass after another: within a row both ends lie in the same array.
    add_block(force.x + i, fx, count);
    add_block(force.y + i, fy, count);
    add_block(force.z + i, fz, count);
    subtract_block(force.x + j, fx, count);
    subtract_block(force.y + j, fy, count);
    subtract_block(force.z + j, fz, count);
  }
}

template <class Real>
[[gnu::always_inline]] inline void add_all(std::span<const SpringFamily> families, const Grid& grid,
                                           const Components<const Real>& position,
                                           const Components<Real>& force) {
  // Row by row, all families of a row together, so that a row is fetched once.
  for (int r = 0; r < grid.rows; ++r) {
    for (const SpringFamily& family : families) {
      if (r + family.rows >= grid.rows) continue;
      SpringRow row{};
      row.first = grid.index(r, std::max(0, -family.cols));
      row.second = grid.index(r + family.rows, std::max(0, family.cols));
      row.count = grid.cols - std::abs(family.cols);
      if (row.count <= 0) continue;
      row.padded = std::min((row.count + kGroup - 1) / kGroup * kGroup, grid.stride - std::abs(family.cols));
      row.share = family.rows == 0 && (r == 0 || r == grid.rows - 1) ? family.border_share : 1.0;
      row.end_share = family.cols == 0 ? family.border_share : 1.0;
      add_row(family, row, position, force);
    }
  }
}

}  // namespace

WEFT_MULTIVERSION void add_spring_forces(std::span<const SpringFamily> families, const Grid& grid,
                                         Components<const float> position, Components<float> force) {
  add_all<float>(families, grid, position, force);
}

WEFT_MULTIVERSION void add_spring_forces(std::span<const SpringFamily> families, const Grid& grid,
                                         Components<const double> position, Components<double> force) {
  add_all<double>(families, grid, position, force);
}

}  // namespace weft::kernels
