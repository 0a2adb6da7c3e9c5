#include "cloth/kernels/plate_kernels.h"

#include <algorithm>
#include <utility>

#include "cloth/kernels/link_rows.h"

namespace weft::kernels {
namespace {

/// Work rows of one component, with room before and after each.
template <class Real>
class PlateRows {
 public:
  static constexpr std::size_t kRows = 8;

  [[gnu::always_inline]] PlateRows(const Grid& grid, Real* work)
      : size_(WorkRows<Real>::row_size(grid)), work_(work) {
    // Beside the columns there are no moments.
    std::fill_n(work_, kRows * size_, Real(0));
  }
  [[gnu::always_inline]] Real* row(std::size_t i) const { return work_ + i * size_ + kRowAlign; }

 private:
  std::size_t size_;
  Real* work_;
};

/// K x of one component, row by row: moments along u at this row, along v at the row before, this and the
/// next, twisting moments at the row before and this.
template <class Real>
class PlateComponent {
 public:
  [[gnu::always_inline]] PlateComponent(const PlateStencils<Real>& plate, const Grid& grid, const Real* x,
                                        int begin, Real* work)
      : plate_(plate), grid_(grid), x_(x) {
    const PlateRows<Real> rows(grid, work);
    above_ = rows.row(0);
    here_ = rows.row(1);
    below_ = rows.row(2);
    twist_above_ = rows.row(3);
    twist_ = rows.row(4);
    along_ = rows.row(5);
    first_ = rows.row(6);
    last_ = rows.row(7);
    std::copy_n(x, grid.stride, first_);
    std::copy_n(x + grid.index(grid.rows - 1, 0), grid.stride, last_);
    // All that a row needs of those before it.
    if (begin > 0) {
      find_moments(begin - 2);
      next_row();
      find_moments(begin - 1);
      next_row();
    } else {
      find_moments(-1);
      next_row();
    }
  }

  /// (K x) at row r, for grouped(cols) columns; rows are asked for one after the other.
  [[gnu::always_inline]] void product(int r, Real* __restrict out) {
    find_moments(r);
    const int count = grouped(grid_.cols);
    const Real* __restrict q = along_;
    const Real* __restrict above = above_;
    const Real* __restrict here = here_;
    const Real* __restrict below = below_;
    const Real* __restrict t = twist_;
    const Real* __restrict t_above = twist_above_;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) {
      const Real along = (q[c - 1] - q[c]) + (q[c + 1] - q[c]);
      const Real down = (above[c] - here[c]) + (below[c] - here[c]);
      out[c] = (along + down) + ((t[c] - t_above[c]) - (t[c - 1] - t_above[c - 1]));
    }
    next_row();
  }

 private:
  /// Row r of x, of which a scalar before and one behind may be read, too.
  [[gnu::always_inline]] const Real* row(int r) const {
    return r == 0 ? first_ : r + 1 == grid_.rows ? last_ : x_ + grid_.index(r, 0);
  }
  /// Moments along u at row r, along v at the next, and twisting between both. Outside of the grid there are
  /// none; behind the last column and beside the rim stiffnesses are zero.
  [[gnu::always_inline]] void find_moments(int r) {
    const int count = grouped(grid_.cols);
    if (r < 0 || r + 2 >= grid_.rows) return find_at_rim(r);
    const Real* __restrict u = plate_.u + grid_.index(r, 0);
    const Real* __restrict v = plate_.v + grid_.index(r + 1, 0);
    const Real* __restrict k = plate_.twist + grid_.index(r, 0);
    const Real *x = row(r), *next = row(r + 1), *second = row(r + 2);
    Real* __restrict along = along_, * __restrict below = below_, * __restrict twist = twist_;
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) {
      const Real d = x[c + 1] - x[c];
      along[c] = u[c] * (d - (x[c] - x[c - 1]));
      below[c] = v[c] * ((x[c] - next[c]) + (second[c] - next[c]));
      twist[c] = k[c] * ((next[c + 1] - next[c]) - d);
    }
  }
  /// The same where the next row or the one behind it is outside, or this.
  [[gnu::noinline]] void find_at_rim(int r) {
    const int count = grouped(grid_.cols);
    std::fill_n(below_, count, Real(0));
    std::fill_n(twist_, count, Real(0));
    std::fill_n(along_, count, Real(0));
    if (r < 0) return;
    const Real* __restrict u = plate_.u + grid_.index(r, 0);
    const Real* x = row(r);
    for (int c = 0; c < count; ++c) along_[c] = u[c] * ((x[c + 1] - x[c]) - (x[c] - x[c - 1]));
    if (r + 1 == grid_.rows) return;
    const Real* __restrict k = plate_.twist + grid_.index(r, 0);
    const Real* next = row(r + 1);
    for (int c = 0; c < count; ++c) twist_[c] = k[c] * ((next[c + 1] - next[c]) - (x[c + 1] - x[c]));
  }
  [[gnu::always_inline]] void next_row() {
    std::swap(twist_above_, twist_);
    Real* free_row = above_;
    above_ = here_;
    here_ = below_;
    below_ = free_row;
  }

  PlateStencils<Real> plate_;
  Grid grid_;
  const Real* x_;
  Real *above_, *here_, *below_, *twist_above_, *twist_, *along_;
  Real *first_, *last_;  ///< copies of the first and the last row, with room
};

/// Calls finish(r, product) for every row r, product being its K x with columns that may be grouped.
template <class Real, class Finish>
[[gnu::always_inline]] inline void for_each_row(const PlateStencils<Real>& plate, const Grid& grid,
                                                const Components<const Real>& x, RowRange rows, Real* work,
                                                Finish finish) {
  const std::size_t row_size = WorkRows<Real>::row_size(grid);
  const std::size_t size = PlateRows<Real>::kRows * row_size;
  PlateComponent<Real> in_x(plate, grid, x.x, rows.begin, work);
  PlateComponent<Real> in_y(plate, grid, x.y, rows.begin, work + size);
  PlateComponent<Real> in_z(plate, grid, x.z, rows.begin, work + 2 * size);
  Real* out = work + 3 * size;
  const Components<Real> product{out, out + row_size, out + 2 * row_size};
  for (int r = rows.begin; r < rows.end; ++r) {
    in_x.product(r, product.x);
    in_y.product(r, product.y);
    in_z.product(r, product.z);
    finish(r, product);
  }
}

template <class Real>
[[gnu::always_inline]] inline double add_any(const PlateStencils<Real>& plate, const Grid& grid,
                                             const Components<const Real>& x, const Real* free_nodes,
                                             const Components<Real>& y, RowRange rows, Real* work) {
  double sum = 0;
  const int count = grouped(grid.cols);
  for_each_row(plate, grid, x, rows, work, [&](int r, const Components<Real>& product) WEFT_INLINE_LAMBDA {
    const std::size_t first = grid.index(r, 0);
    const Real* __restrict free = free_nodes + first;
    const auto add = [&](Real* __restrict out, Real* __restrict k_x) WEFT_INLINE_LAMBDA {
      WEFT_INDEPENDENT_ITERATIONS
      for (int c = 0; c < count; ++c) {
        k_x[c] *= free[c];
        out[c] += k_x[c];
      }
    };
    add(y.x + first, product.x);
    add(y.y + first, product.y);
    add(y.z + first, product.z);
    DotProduct<Real> dot;
    dot.add_row({product.x, product.y, product.z}, x + first, 0, count);
    sum += dot.sum();
  });
  return sum;
}

template <class Real>
[[gnu::always_inline]] inline void subtract_any(const PlateStencils<Real>& plate, const Grid& grid,
                                                const Components<const Real>& x, const Real* free_nodes,
                                                const Components<Real>& y, RowRange rows, Real* work) {
  const int count = grouped(grid.cols);
  for_each_row(plate, grid, x, rows, work, [&](int r, const Components<Real>& product) WEFT_INLINE_LAMBDA {
    const std::size_t first = grid.index(r, 0);
    const Real* __restrict free = free_nodes + first;
    const auto subtract = [&](Real* __restrict out, const Real* __restrict k_x) WEFT_INLINE_LAMBDA {
      WEFT_INDEPENDENT_ITERATIONS
      for (int c = 0; c < count; ++c) out[c] -= free[c] * k_x[c];
    };
    subtract(y.x + first, product.x);
    subtract(y.y + first, product.y);
    subtract(y.z + first, product.z);
  });
}

template <class Real>
[[gnu::always_inline]] inline double relax_any(const PlateStencils<Real>& plate, const Grid& grid,
                                               const Blocks<Real>& inverse, const Components<const Real>& x,
                                               const Components<const Real>& b, const Components<Real>& out,
                                               RowRange rows, Real* work) {
  double sum = 0;
  const int count = grouped(grid.cols);
  for_each_row(plate, grid, x, rows, work, [&](int r, const Components<Real>& product) WEFT_INLINE_LAMBDA {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(grid.index(r, 0));
    WEFT_INDEPENDENT_ITERATIONS
    for (int c = 0; c < count; ++c) {
      const std::ptrdiff_t i = first + c;
      const Triple<Real> change = force_of(inverse, i, -product.x[c], -product.y[c], -product.z[c]);
      out.x[i] += change.x;
      out.y[i] += change.y;
      out.z[i] += change.z;
      product.x[c] = change.x;
      product.y[c] = change.y;
      product.z[c] = change.z;
    }
    DotProduct<Real> dot;
    dot.add_row({product.x, product.y, product.z}, b + static_cast<std::size_t>(first), 0, count);
    sum += dot.sum();
  });
  return sum;
}

}  // namespace

std::size_t plate_work_size(const Grid& grid) {
  return 3 * (PlateRows<float>::kRows + 1) * WorkRows<float>::row_size(grid);
}

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_PLATE_KERNELS(Real)                                                                             \
  template <>                                                                                                \
  WEFT_MULTIVERSION double add_plate(const PlateStencils<Real>& plate, const Grid& grid,                     \
                                     Components<const Real> x, const Real* free, Components<Real> y,         \
                                     RowRange rows, Real* work) {                                            \
    return add_any<Real>(plate, grid, x, free, y, rows, work);                                               \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void subtract_plate(const PlateStencils<Real>& plate, const Grid& grid,                  \
                                        Components<const Real> x, const Real* free, Components<Real> y,      \
                                        RowRange rows, Real* work) {                                         \
    subtract_any<Real>(plate, grid, x, free, y, rows, work);                                                 \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION double relax_plate(                                                                      \
      const PlateStencils<Real>& plate, const Grid& grid, const Blocks<Real>& inverse,                       \
      Components<const Real> x, Components<const Real> b, Components<Real> out, RowRange rows, Real* work) { \
    return relax_any<Real>(plate, grid, inverse, x, b, out, rows, work);                                     \
  }

WEFT_PLATE_KERNELS(float)
WEFT_PLATE_KERNELS(double)
#undef WEFT_PLATE_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
