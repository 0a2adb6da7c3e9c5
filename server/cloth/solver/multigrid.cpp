#include "cloth/solver/multigrid.h"

#include <algorithm>

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/kernels/transfer_kernels.h"

namespace weft {
namespace {

/// Block Jacobi's damping. From 0.65 to 0.9 it hardly matters: a falling and swinging sheet (scene H of the
/// engines' benchmark) takes 3.6 to 3.8 iterations a solve, a flat stiff one 17 to 15. Below 1 it is safe for
/// any sheet: block Jacobi's largest eigenvalue is at most 2.
constexpr double kDamping = 0.65;

bool can_coarsen(const Grid& grid) {
  return grid.rows % 2 == 1 && grid.cols % 2 == 1 && grid.rows >= 5 && grid.cols >= 5;
}

/// Gives both nodes of each pair the inverse of the mean of the two matrices whose inverses are there.
template <class Real>
void invert_means(const Seam<Real>& seam, const kernels::Blocks<Real>& inverse) {
  const auto block = [&](std::size_t i) {
    const auto xy = double(inverse.xy[i]), xz = double(inverse.xz[i]), yz = double(inverse.yz[i]);
    return Eigen::Matrix3d{
        {double(inverse.xx[i]), xy, xz}, {xy, double(inverse.yy[i]), yz}, {xz, yz, double(inverse.zz[i])}};
  };
  for (const auto& [left, right] : seam.pairs()) {
    const Eigen::Matrix3d one = block(left), two = block(right);
    if (one.trace() == 0) continue;  // they are fixed
    const Eigen::Matrix3d both = 2 * one * (one + two).inverse() * two;
    for (const std::size_t i : {left, right}) {
      inverse.xx[i] = static_cast<Real>(both(0, 0));
      inverse.xy[i] = static_cast<Real>(both(0, 1));
      inverse.xz[i] = static_cast<Real>(both(0, 2));
      inverse.yy[i] = static_cast<Real>(both(1, 1));
      inverse.yz[i] = static_cast<Real>(both(1, 2));
      inverse.zz[i] = static_cast<Real>(both(2, 2));
    }
  }
}

Grid coarser(const Grid& grid) { return Grid::with_nodes((grid.rows + 1) / 2, (grid.cols + 1) / 2); }

}  // namespace

template <class Real>
std::size_t Multigrid<Real>::work_size(const Grid& finest, const Plate<Real>* plate) {
  const std::size_t links = kernels::link_work_size(finest);
  return plate != nullptr ? std::max(links, kernels::plate_work_size(finest)) : links;
}

template <class Real>
Multigrid<Real>::Multigrid(const Grid& finest, bool has_bending, const Plate<Real>* plate, bool sewn)
    : finest_(finest, has_bending, plate),
      work_size_(work_size(finest, plate)),
      work_(static_cast<std::size_t>(finest_.bands.count()) * work_size_, Real(0)) {
  std::optional<Plate<Real>> coarse_plate = finest_.plate;
  for (Grid grid = finest; can_coarsen(grid);) {
    grid = coarser(grid);
    if (coarse_plate) coarse_plate = coarse_plate->coarser();
    coarse_.emplace_back(grid, false, coarse_plate ? &*coarse_plate : nullptr);
  }
  if (sewn) {
    seams_.emplace_back(finest);
    for (const Coarse& level : coarse_) seams_.emplace_back(level.matrix.grid);
  } else {
    lines_.emplace(finest);
  }
  if (!coarse_.empty()) coarsest_.emplace(coarse_.back().matrix.grid, sewn ? &seams_.back() : nullptr);
}

template <class Real>
void Multigrid<Real>::prepare() {
  prepare_level(finest_, 0);
  for (std::size_t i = 0; i < coarse_.size(); ++i) {
    if (i == 0) {
      coarsen(finest_, coarse_[0]);
    } else {
      coarsen(coarse_[i - 1], coarse_[i]);
    }
    if (i + 1 < coarse_.size()) prepare_level(coarse_[i], i + 1);
  }
  if (!coarsest_) return;
  const auto& plate = coarse_.back().plate;
  coarsest_->factorise(coarse_.back().matrix, plate ? &*plate : nullptr);
}

template <class Real>
template <class Fine>
void Multigrid<Real>::prepare_level(Fine& level, std::size_t index) {
  level.weigh_plate();
  const auto smoothed = level.smoothed();
  if constexpr (std::is_same_v<Fine, GridLevel<Real, kernels::SpringLinks<Real>>>) {
    if (lines_) return lines_->factorise(smoothed);
  }
  level.bands.for_each([&](kernels::RowRange rows, int) {
    kernels::invert_diagonal(smoothed, static_cast<Real>(kDamping), level.inverse, rows);
  });
  if (!seams_.empty()) invert_means(seams_[index], level.inverse);
}

template <class Real>
template <class Fine>
void Multigrid<Real>::coarsen(Fine& fine, Coarse& coarse) {
  const Grid &fine_grid = fine.matrix.grid, &grid = coarse.matrix.grid;
  coarse.use_blocks(fine.matrix.has_blocks);
  const auto from = fine.matrix.blocks;
  const auto to = coarse.matrix.blocks;
  coarse.bands.for_each([&](kernels::RowRange rows, int band) {
    kernels::coarsen_links(fine_grid, fine.matrix.links, grid, coarse.matrix.links, rows);
    const auto restrict_rows = [&](const Real* values, Real* sums) {
      kernels::restrict_sum(fine_grid, values, grid, sums, rows, work(band));
    };
    restrict_rows(fine.matrix.diagonal, coarse.diagonal());
    if (fine.matrix.has_blocks) {
      restrict_rows(from.xx, to.xx);
      restrict_rows(from.xy, to.xy);
      restrict_rows(from.xz, to.xz);
      restrict_rows(from.yy, to.yy);
      restrict_rows(from.yz, to.yz);
      restrict_rows(from.zz, to.zz);
    }
    for (int r = rows.begin; r < rows.end; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        coarse.free()[grid.index(r, c)] = fine.free()[fine_grid.index(2 * r, 2 * c)];
      }
    }
  });
}

template <class Real>
double Multigrid<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) {
  double product = finest_.bands.sum([&](kernels::RowRange rows, int band) {
    const double links = kernels::multiply(finest_.matrix, x, y, rows, work(band));
    if (!finest_.plate) return links;
    return links + kernels::add_plate<Real>(finest_.plate->stencils(), grid(), x, finest_.matrix.free, y,
                                            rows, work(band));
  });
  if (!bodies_.empty()) product += bodies_.multiply(x, y);
  if (!couplings_.empty()) product += couplings_.multiply(x, y);
  if (rank_one_ > 0) {
    const double along = kernels::dot<Real>(rank_one_by_, x, grid());
    kernels::add_scaled(y, rank_one_by_, static_cast<Real>(rank_one_ * along), grid().size());
    product += rank_one_ * along * along;
  }
  if (!seams_.empty()) seams_[0].average(y);
  return product;
}

template <class Real>
void Multigrid<Real>::set_rank_one(double stiffness, kernels::Components<const Real> vector) {
  rank_one_ = stiffness;
  rank_one_by_ = vector;
}

template <class Real>
double Multigrid<Real>::precondition(kernels::Components<const Real> r, kernels::Components<Real> z) {
  return cycle(finest_, 0, r, z);
}

template <class Real>
template <class Links>
void Multigrid<Real>::smooth_first(GridLevel<Real, Links>& level, kernels::Components<const Real> b) {
  if constexpr (std::is_same_v<Links, kernels::SpringLinks<Real>>) {
    if (lines_) return lines_->start(level.matrix, b, level.x);
  }
  level.bands.for_each_stretch([&](std::size_t first, std::size_t count) {
    kernels::apply_blocks(level.inverse + first, b + first, level.x + first, count);
  });
}

template <class Real>
template <class Links>
double Multigrid<Real>::smooth_last(GridLevel<Real, Links>& level, kernels::Components<const Real> b,
                                    kernels::Components<Real> z) {
  if constexpr (std::is_same_v<Links, kernels::SpringLinks<Real>>) {
    if (lines_) {
      find_residual(level, b);
      return lines_->finish(level.matrix, {level.y, level.x, b, z});
    }
  }
  return level.bands.sum([&](kernels::RowRange rows, int band) {
    const double links =
        kernels::relax<Real, Links>(level.matrix, level.inverse, level.x, b, z, rows, work(band));
    if (!level.cycles_plate) return links;
    return links + kernels::relax_plate<Real>(level.plate->stencils(), level.matrix.grid, level.inverse,
                                              level.x, b, z, rows, work(band));
  });
}

template <class Real>
template <class Links>
void Multigrid<Real>::find_residual(GridLevel<Real, Links>& level, kernels::Components<const Real> b) {
  level.bands.for_each([&](kernels::RowRange rows, int band) {
    kernels::residual<Real, Links>(level.matrix, level.x, b, level.y, rows, work(band));
    if (!level.cycles_plate) return;
    kernels::subtract_plate<Real>(level.plate->stencils(), level.matrix.grid, level.x, level.matrix.free,
                                  level.y, rows, work(band));
  });
}

template <class Real>
template <class Links>
double Multigrid<Real>::cycle(GridLevel<Real, Links>& level, std::size_t next,
                              kernels::Components<const Real> b, kernels::Components<Real> z) {
  const Grid& grid = level.matrix.grid;
  smooth_first(level, b);
  if (next < coarse_.size()) {
    Coarse& coarse = coarse_[next];
    const Grid& coarse_grid = coarse.matrix.grid;
    find_residual(level, b);
    coarse.bands.for_each([&](kernels::RowRange rows, int band) {
      kernels::restrict_sum<Real>(grid, level.y.x, coarse_grid, coarse.b.x, rows, work(band));
      kernels::restrict_sum<Real>(grid, level.y.y, coarse_grid, coarse.b.y, rows, work(band));
      kernels::restrict_sum<Real>(grid, level.y.z, coarse_grid, coarse.b.z, rows, work(band));
    });
    if (!seams_.empty()) seams_[next + 1].average(coarse.b);
    const kernels::Components<Real> correction = coarse.y;
    if (next + 1 < coarse_.size()) {
      cycle(coarse, next + 1, coarse.b, correction);
    } else {
      coarsest_->solve(coarse.b, correction);
    }
    const Real* free = level.matrix.free;
    level.bands.for_each([&](kernels::RowRange rows, int band) {
      kernels::prolong_add<Real>(coarse_grid, correction.x, grid, free, level.x.x, rows, work(band));
      kernels::prolong_add<Real>(coarse_grid, correction.y, grid, free, level.x.y, rows, work(band));
      kernels::prolong_add<Real>(coarse_grid, correction.z, grid, free, level.x.z, rows, work(band));
    });
  }
  const double product = smooth_last(level, b, z);
  if (!seams_.empty()) seams_[next].average(z);
  return product;
}

template class Multigrid<float>;
template class Multigrid<double>;

}  // namespace weft
