#include "cloth/solver/multigrid.h"

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/transfer_kernels.h"

namespace weft {
namespace {

/// Block Jacobi's damping. From 0.65 to 0.9 it hardly matters: a falling and swinging sheet (scene H of the
/// engines' benchmark) takes 3.6 to 3.8 iterations a solve, a flat stiff one 17 to 15. Below 1 it is safe for
/// any sheet: block Jacobi's largest eigenvalue is at most 2.
constexpr double kDamping = 0.65;

template <class Real>
void bind(NodeArrays<Real>& links, kernels::SpringLinks<Real>& family, int index) {
  family = {links[4 * index], links[4 * index + 1], links[4 * index + 2], links[4 * index + 3]};
}
template <class Real>
void bind(NodeArrays<Real>& links, kernels::Blocks<Real>& family, int index) {
  family = links.blocks(6 * index);
}

bool can_coarsen(const Grid& grid) {
  return grid.rows % 2 == 1 && grid.cols % 2 == 1 && grid.rows >= 5 && grid.cols >= 5;
}
Grid coarser(const Grid& grid) { return Grid::with_nodes((grid.rows + 1) / 2, (grid.cols + 1) / 2); }

}  // namespace

template <class Real, class Links>
GridLevel<Real, Links>::GridLevel(const Grid& grid, bool has_bending)
    : numbers_(grid, 2),
      links_(grid, (has_bending ? 6 : 4) * static_cast<int>(sizeof(Links) / sizeof(Real*))),
      inverse_(grid, 6),
      vectors_(grid, 9) {
  matrix.grid = grid;
  kernels::LinkFamilies<Links>& families = matrix.links;
  int index = 0;
  for (Links* family : {&families.along_u, &families.along_v, &families.falling, &families.rising}) {
    bind(links_, *family, index++);
  }
  if (has_bending) {
    bind(links_, families.bending_u, index++);
    bind(links_, families.bending_v, index++);
  }
  families.has_bending = has_bending;
  matrix.diagonal = numbers_[0];
  matrix.free = numbers_[1];
  inverse = inverse_.blocks();
  b = vectors_.vector(0);
  x = vectors_.vector(3);
  y = vectors_.vector(6);
}

template <class Real, class Links>
void GridLevel<Real, Links>::use_blocks(bool use) {
  if (use && matrix.blocks.xx == nullptr) {
    blocks_ = NodeArrays<Real>(matrix.grid, 6);
    matrix.blocks = blocks_.blocks();
  } else if (use) {
    blocks_.clear();
  }
  matrix.has_blocks = use;
}

template struct GridLevel<float, kernels::SpringLinks<float>>;
template struct GridLevel<double, kernels::SpringLinks<double>>;

template <class Real>
Multigrid<Real>::Multigrid(const Grid& finest, bool has_bending)
    : finest_(finest, has_bending), work_(kernels::link_work_size(finest), Real(0)) {
  for (Grid grid = finest; can_coarsen(grid);) {
    grid = coarser(grid);
    coarse_.emplace_back(grid, false);
  }
  if (!coarse_.empty()) coarsest_.emplace(coarse_.back().matrix.grid);
}

template <class Real>
void Multigrid<Real>::prepare() {
  const auto prepare_level = [&](auto& level) {
    kernels::invert_diagonal(level.matrix, static_cast<Real>(kDamping), level.inverse);
  };
  const auto coarsen = [&](auto& fine, Coarse& coarse) {
    const Grid &fine_grid = fine.matrix.grid, &grid = coarse.matrix.grid;
    kernels::coarsen_links(fine_grid, fine.matrix.links, grid, coarse.matrix.links);
    kernels::restrict_sum(fine_grid, fine.matrix.diagonal, grid, coarse.diagonal(), work_.data());
    coarse.use_blocks(fine.matrix.has_blocks);
    if (fine.matrix.has_blocks) {
      const auto from = fine.matrix.blocks;
      const auto to = coarse.matrix.blocks;
      for (const auto& [f, t] : {std::pair{from.xx, to.xx},
                                 {from.xy, to.xy},
                                 {from.xz, to.xz},
                                 {from.yy, to.yy},
                                 {from.yz, to.yz},
                                 {from.zz, to.zz}}) {
        kernels::restrict_sum(fine_grid, f, grid, t, work_.data());
      }
    }
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        coarse.free()[grid.index(r, c)] = fine.free()[fine_grid.index(2 * r, 2 * c)];
      }
    }
  };
  prepare_level(finest_);
  for (std::size_t i = 0; i < coarse_.size(); ++i) {
    if (i == 0) {
      coarsen(finest_, coarse_[0]);
    } else {
      coarsen(coarse_[i - 1], coarse_[i]);
    }
    if (i + 1 < coarse_.size()) prepare_level(coarse_[i]);
  }
  if (coarsest_) coarsest_->factorise(coarse_.back().matrix);
}

template <class Real>
double Multigrid<Real>::multiply(kernels::Components<const Real> x, kernels::Components<Real> y) {
  return kernels::multiply(finest_.matrix, x, y, {0, grid().rows}, work_.data());
}

template <class Real>
double Multigrid<Real>::precondition(kernels::Components<const Real> r, kernels::Components<Real> z) {
  return cycle(finest_, 0, r, z);
}

template <class Real>
template <class Links>
double Multigrid<Real>::cycle(GridLevel<Real, Links>& level, std::size_t next,
                              kernels::Components<const Real> b, kernels::Components<Real> z) {
  const Grid& grid = level.matrix.grid;
  const kernels::RowRange all{0, grid.rows};
  kernels::apply_blocks(level.inverse, b, level.x, grid.size());
  if (next < coarse_.size()) {
    Coarse& coarse = coarse_[next];
    const Grid& coarse_grid = coarse.matrix.grid;
    kernels::residual<Real, Links>(level.matrix, level.x, b, level.y, all, work_.data());
    for (const auto& [from, to] :
         {std::pair{level.y.x, coarse.b.x}, {level.y.y, coarse.b.y}, {level.y.z, coarse.b.z}}) {
      kernels::restrict_sum<Real>(grid, from, coarse_grid, to, work_.data());
    }
    kernels::Components<Real> correction = coarse.y;
    if (next + 1 < coarse_.size()) {
      cycle(coarse, next + 1, coarse.b, correction);
    } else {
      coarsest_->solve(coarse.b, correction);
    }
    for (const auto& [from, to] :
         {std::pair{correction.x, level.x.x}, {correction.y, level.x.y}, {correction.z, level.x.z}}) {
      kernels::prolong_add<Real>(coarse_grid, from, grid, level.matrix.free, to, work_.data());
    }
  }
  return kernels::relax<Real, Links>(level.matrix, level.inverse, level.x, b, z, all, work_.data());
}

template class Multigrid<float>;
template class Multigrid<double>;

}  // namespace weft
