#include "cloth/solver/grid_level.h"

#include <algorithm>
#include <functional>

namespace weft {
namespace {

/// A plate at most so many times as stiff as the inertia is left to conjugate gradients: its stiffest modes
/// are a few among many. The implicit flag at level 6 then takes 1.17 times the instructions of one without a
/// plate, 1.35 with 1 in place of 4, 1.47 if the cycle never leaves the plate out.
constexpr double kOutweighed = 4;

template <class Real>
void bind(NodeArrays<Real>& links, kernels::SpringLinks<Real>& family, int index) {
  family = {links[4 * index], links[4 * index + 1], links[4 * index + 2], links[4 * index + 3]};
}
template <class Real>
void bind(NodeArrays<Real>& links, kernels::Blocks<Real>& family, int index) {
  family = links.blocks(6 * index);
}

}  // namespace

template <class Real, class Links>
GridLevel<Real, Links>::GridLevel(const Grid& grid, bool has_bending, const Plate<Real>* bent)
    : bands(grid),
      numbers_(grid, bent != nullptr ? 3 : 2),
      links_(grid, (has_bending ? 6 : 4) * static_cast<int>(sizeof(Links) / sizeof(Real*))),
      inverse_(grid, 6),
      vectors_(grid, 9) {
  matrix.grid = grid;
  if (bent != nullptr) plate = *bent;
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

template <class Real, class Links>
void GridLevel<Real, Links>::weigh_plate() {
  if (!plate) return;
  // K <= 2 D: leaving it out raises the condition number by at most 1 + kOutweighed.
  const Real* held = plate->smoother().row(0);
  const Real* inertia = diagonal();
  cycles_plate = false;
  for (std::size_t i = 0; i < matrix.grid.size() && !cycles_plate; ++i) {
    cycles_plate = Real(2) * held[i] > static_cast<Real>(kOutweighed) * inertia[i];
  }
}

template <class Real, class Links>
kernels::LinkMatrix<Real, Links> GridLevel<Real, Links>::smoothed() {
  kernels::LinkMatrix<Real, Links> seen = matrix;
  if (cycles_plate) {
    Real* sum = numbers_[2];
    std::transform(diagonal(), diagonal() + matrix.grid.size(), plate->smoother().row(0), sum, std::plus<>());
    seen.diagonal = sum;
  }
  return seen;
}

template struct GridLevel<float, kernels::SpringLinks<float>>;
template struct GridLevel<double, kernels::SpringLinks<double>>;
template struct GridLevel<float, kernels::Blocks<float>>;
template struct GridLevel<double, kernels::Blocks<double>>;

}  // namespace weft
