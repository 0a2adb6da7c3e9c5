#include "cloth/solver/line_smoother.h"

#include <numeric>

namespace weft {
namespace {

/// Of each direction: A <= 2 L for both, so that together they are safe below 0.5.
constexpr double kLineDamping = 0.45;
/// Columns of a band of warp lines: on the way back a second level cache still holds what the way down read.
constexpr int kColumns = 32;

}  // namespace

template <class Real>
LineSmoother<Real>::LineSmoother(const Grid& grid)
    : grid_(grid),
      column_bands_((grid.stride + kColumns - 1) / kColumns),
      alone_(Bands(grid).count() == 1),
      groups_((grid.rows + kernels::kWeftLines - 1) / kernels::kWeftLines),
      nodes_(grid, 6),
      warp_(grid, 9),
      work_size_(kernels::line_work_size(grid)),
      weft_size_(kernels::weft_factors_size(grid)),
      weft_(static_cast<std::size_t>(groups_) * weft_size_, Real(0)),
      work_(static_cast<std::size_t>(std::max(groups_, column_bands_)) * work_size_, Real(0)),
      products_(static_cast<std::size_t>(groups_)) {}

template <class Real>
template <class Work>
void LineSmoother<Real>::for_each_part(int parts, const Work& work) const {
  if (!alone_) return parallel_for(parts, work);
  for (int part = 0; part < parts; ++part) work(part);
}

template <class Real>
template <class Work>
void LineSmoother<Real>::for_each_column_band(const Work& work) const {
  for_each_part(column_bands_, [&](int band) {
    work(kernels::ColumnRange{band * kColumns, std::min((band + 1) * kColumns, grid_.stride)}, band);
  });
}

template <class Real>
template <class Work>
void LineSmoother<Real>::for_each_group(const Work& work) const {
  for_each_part(groups_, [&](int group) { work(group * kernels::kWeftLines, group); });
}

template <class Real>
void LineSmoother<Real>::factorise(const Matrix& matrix) {
  for_each_column_band([&](kernels::ColumnRange columns, int band) {
    kernels::factorise_warp(matrix, nodes_.blocks(), warp_factors(), columns, work(band));
  });
  for_each_group([&](int first, int group) {
    kernels::factorise_weft(matrix, nodes_.blocks(), weft(group), first, work(group));
  });
}

template <class Real>
void LineSmoother<Real>::start(const Matrix& matrix, kernels::Components<const Real> b,
                               kernels::Components<Real> x) {
  add_warp(matrix, {b, x, {}});
  add_weft({b, x, b, x});
}

template <class Real>
double LineSmoother<Real>::finish(const Matrix& matrix, const Sweep& sweep) {
  const auto& [r, x, b, z] = sweep;
  add_warp(matrix, {r, z, x});
  return add_weft({r, x, b, z});
}

template <class Real>
void LineSmoother<Real>::add_warp(const Matrix& matrix, const kernels::WarpSolve<Real>& fields) {
  for_each_column_band([&](kernels::ColumnRange columns, int band) {
    kernels::solve_warp<Real>(matrix, warp_factors(), static_cast<Real>(kLineDamping), fields, columns,
                              work(band));
  });
}

template <class Real>
double LineSmoother<Real>::add_weft(const kernels::WeftSolve<Real>& fields) {
  for_each_group([&](int first, int group) {
    products_[static_cast<std::size_t>(group)] = kernels::solve_weft<Real>(
        grid_, weft(group), static_cast<Real>(kLineDamping), fields, first, work(group));
  });
  return std::accumulate(products_.begin(), products_.end(), 0.0);
}

template class LineSmoother<float>;
template class LineSmoother<double>;

}  // namespace weft
