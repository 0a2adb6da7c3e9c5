#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/link_kernels.h"

/// How link kernels go through a grid; for their .cpp files only.
namespace weft::kernels {

/// Scalars that are handled together; whole groups, so that no remainder is left to a scalar loop.
inline constexpr int kLinkGroup = 8;

inline int grouped(int cols) { return (cols + kLinkGroup - 1) / kLinkGroup * kLinkGroup; }

/// 1 where x > 0, else 0; `positive` is max(0, x). Without a comparison, which would keep the loop from being
/// vectorised.
template <class Real>
[[gnu::always_inline]] inline Real unit_step(Real x, Real positive) {
  return positive / (std::abs(x) + std::numeric_limits<Real>::min());
}

template <class Real>
struct Triple {
  Real x, y, z;
};

template <class Real>
[[gnu::always_inline]] inline Triple<Real> force_of(const SpringLinks<Real>& link, std::ptrdiff_t i, Real dx,
                                                    Real dy, Real dz) {
  const Real a = link.a[i], mx = link.x[i], my = link.y[i], mz = link.z[i];
  const Real along = mx * dx + my * dy + mz * dz;
  return {a * dx + mx * along, a * dy + my * along, a * dz + mz * along};
}

template <class Real>
[[gnu::always_inline]] inline Triple<Real> force_of(const Blocks<Real>& block, std::ptrdiff_t i, Real dx,
                                                    Real dy, Real dz) {
  const Real xy = block.xy[i], xz = block.xz[i], yz = block.yz[i];
  return {block.xx[i] * dx + xy * dy + xz * dz, xy * dx + block.yy[i] * dy + yz * dz,
          xz * dx + yz * dy + block.zz[i] * dz};
}

/// Work rows: forces that wait for another column or row, three components each, with room at both ends.
template <class Real>
class WorkRows {
 public:
  static constexpr int kVectors = 8;
  static std::size_t row_size(const Grid& grid) {
    return static_cast<std::size_t>(grid.stride) + 2 * std::size_t{kRowAlign};
  }

  [[gnu::always_inline]] WorkRows(const Grid& grid, Real* work) : size_(row_size(grid)), work_(work) {}
  [[gnu::always_inline]] Components<Real> vector(std::size_t i) const {
    Real* row = work_ + 3 * i * size_ + kRowAlign;
    return {row, row + size_, row + 2 * size_};
  }

 private:
  std::size_t size_;
  Real* work_;
};

template <class Real>
[[gnu::always_inline]] inline void set_zero(const Components<Real>& row, int begin, int end) {
  for (int c = begin; c < end; ++c) row.x[c] = row.y[c] = row.z[c] = Real(0);
}

/// Calls finish(i, force) for every node i of the rows, force being links(x) there. Each link is evaluated
/// once: its second end gets its share from a work row. A row's sum is formed in the same order wherever the
/// range begins, so a grid may be cut into ranges without changing a bit.
template <class Real, bool kBending, class Links, class Finish>
[[gnu::always_inline]] inline void for_each_link_force(const LinkFamilies<Links>& links, const Grid& grid,
                                                       const Components<const Real>& x, RowRange rows,
                                                       Real* work, Finish finish) {
  const WorkRows<Real> vectors(grid, work);
  const Components<Real> own = vectors.vector(0), along = vectors.vector(1), second = vectors.vector(2),
                         falling = vectors.vector(3), rising = vectors.vector(4);
  // What the rows above pull with: at this row, the next and the second next.
  Components<Real> here = vectors.vector(5), next = vectors.vector(6), after = vectors.vector(7);
  const int count = grouped(grid.cols);
  const std::ptrdiff_t stride = grid.stride;
  set_zero(here, 0, count);
  set_zero(next, 0, count);
  set_zero(after, 0, count);
  // Beyond both ends there are no links.
  set_zero(along, -1, 0);
  set_zero(second, -2, 0);
  set_zero(falling, -1, 0);
  set_zero(rising, count, count + 1);
  for (int r = std::max(0, rows.begin - (kBending ? 2 : 1)); r < rows.end; ++r) {
    const std::ptrdiff_t first = r * stride;
    const Real* __restrict x0 = x.x + first;
    const Real* __restrict y0 = x.y + first;
    const Real* __restrict z0 = x.z + first;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) {
      const Real px = x0[c], py = y0[c], pz = z0[c];
      const std::ptrdiff_t i = first + c;
      const Triple<Real> u = force_of(links.along_u, i, px - x0[c + 1], py - y0[c + 1], pz - z0[c + 1]);
      along.x[c] = u.x;
      along.y[c] = u.y;
      along.z[c] = u.z;
      const Triple<Real> v =
          force_of(links.along_v, i, px - x0[c + stride], py - y0[c + stride], pz - z0[c + stride]);
      if constexpr (kBending) {
        next.x[c] -= v.x;
        next.y[c] -= v.y;
        next.z[c] -= v.z;
      } else {
        next.x[c] = -v.x;
        next.y[c] = -v.y;
        next.z[c] = -v.z;
      }
      const Triple<Real> f = force_of(links.falling, i, px - x0[c + stride + 1], py - y0[c + stride + 1],
                                      pz - z0[c + stride + 1]);
      falling.x[c] = f.x;
      falling.y[c] = f.y;
      falling.z[c] = f.z;
      const Triple<Real> g = force_of(links.rising, i, px - x0[c + stride - 1], py - y0[c + stride - 1],
                                      pz - z0[c + stride - 1]);
      rising.x[c] = g.x;
      rising.y[c] = g.y;
      rising.z[c] = g.z;
      Triple<Real> sum{(u.x + v.x) + (f.x + g.x), (u.y + v.y) + (f.y + g.y), (u.z + v.z) + (f.z + g.z)};
      if constexpr (kBending) {
        const Triple<Real> a = force_of(links.bending_u, i, px - x0[c + 2], py - y0[c + 2], pz - z0[c + 2]);
        second.x[c] = a.x;
        second.y[c] = a.y;
        second.z[c] = a.z;
        const Triple<Real> b = force_of(links.bending_v, i, px - x0[c + 2 * stride], py - y0[c + 2 * stride],
                                        pz - z0[c + 2 * stride]);
        after.x[c] = -b.x;
        after.y[c] = -b.y;
        after.z[c] = -b.z;
        sum = {sum.x + (a.x + b.x), sum.y + (a.y + b.y), sum.z + (a.z + b.z)};
      }
      own.x[c] = sum.x + here.x[c];
      own.y[c] = sum.y + here.y[c];
      own.z[c] = sum.z + here.z[c];
    }
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) {
      next.x[c] -= falling.x[c - 1] + rising.x[c + 1];
      next.y[c] -= falling.y[c - 1] + rising.y[c + 1];
      next.z[c] -= falling.z[c - 1] + rising.z[c + 1];
    }
    if (r >= rows.begin) {
      WEFT_INDEPENDENT_ITERATIONS
      for (int c = 0; c < count; ++c) {
        Triple<Real> force{own.x[c] - along.x[c - 1], own.y[c] - along.y[c - 1], own.z[c] - along.z[c - 1]};
        if constexpr (kBending) {
          force = {force.x - second.x[c - 2], force.y - second.y[c - 2], force.z - second.z[c - 2]};
        }
        finish(first + c, force);
      }
    }
    std::swap(here, next);
    if constexpr (kBending) std::swap(next, after);
  }
}

/// a . b over `count` scalars of the three components, a multiple of kLinkGroup: the same bits with every
/// instruction set.
template <class Real>
class DotProduct {
 public:
  [[gnu::always_inline]] void add(const Real* __restrict a, const Real* __restrict b, int count) {
    for (int c = 0; c < count; c += kLinkGroup) {
      for (int lane = 0; lane < kLinkGroup; ++lane) lanes_[lane] += a[c + lane] * b[c + lane];
    }
  }
  [[gnu::always_inline]] void add_row(const Components<const Real>& a, const Components<const Real>& b,
                                      std::ptrdiff_t first, int count) {
    add(a.x + first, b.x + first, count);
    add(a.y + first, b.y + first, count);
    add(a.z + first, b.z + first, count);
    for (int lane = 0; lane < kLinkGroup; ++lane) {
      sums_[lane] += static_cast<double>(lanes_[lane]);
      lanes_[lane] = Real(0);
    }
  }
  [[gnu::always_inline]] double sum() const {
    double total = 0;
    for (const double lane : sums_) total += lane;
    return total;
  }

 private:
  Real lanes_[kLinkGroup]{};
  double sums_[kLinkGroup]{};
};

/// a . b on the rows.
template <class Real>
[[gnu::always_inline]] inline double dot_rows(const Grid& grid, const Components<const Real>& a,
                                              const Components<const Real>& b, RowRange rows) {
  double sum = 0;
  for (int r = rows.begin; r < rows.end; ++r) {
    DotProduct<Real> dot;
    dot.add_row(a, b, static_cast<std::ptrdiff_t>(grid.index(r, 0)), grouped(grid.cols));
    sum += dot.sum();
  }
  return sum;
}

}  // namespace weft::kernels
