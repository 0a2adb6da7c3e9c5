#include "cloth/levels/refine.h"

#include <algorithm>
#include <stdexcept>

namespace weft {
namespace {

void require_nested(const Grid& coarse, const Grid& fine) {
  if (fine.rows != 2 * coarse.rows - 1 || fine.cols != 2 * coarse.cols - 1) {
    throw std::invalid_argument("the fine grid must have 2 n - 1 nodes where the coarse one has n");
  }
}

/// Eq. 8 for one quantity: A_e = (A_a + A_b)/2 on an edge, A_i = (A_a + A_b + A_c + A_d)/4 in the middle.
template <class Real>
void split_field(const Field<Real>& coarse, Field<Real>& fine) {
  const int rows = coarse.grid().rows;
  const auto last = static_cast<std::size_t>(coarse.grid().cols - 1);
  for (int r = 0; r < rows; ++r) {
    const Real* from = coarse.row(r);
    Real* to = fine.row(2 * r);
    for (std::size_t c = 0; c <= last; ++c) to[2 * c] = from[c];
    for (std::size_t c = 0; c < last; ++c) to[2 * c + 1] = (from[c] + from[c + 1]) / 2;
  }
  for (int r = 0; r + 1 < rows; ++r) {
    const Real* above = coarse.row(r);
    const Real* below = coarse.row(r + 1);
    Real* to = fine.row(2 * r + 1);
    for (std::size_t c = 0; c <= last; ++c) to[2 * c] = (above[c] + below[c]) / 2;
    for (std::size_t c = 0; c < last; ++c) {
      to[2 * c + 1] = (above[c] + above[c + 1] + below[c] + below[c + 1]) / 4;
    }
  }
}

template <class Real>
void merge_field(const Field<Real>& fine, Field<Real>& coarse) {
  const auto cols = static_cast<std::size_t>(coarse.grid().cols);
  for (int r = 0; r < coarse.grid().rows; ++r) {
    const Real* from = fine.row(2 * r);
    Real* to = coarse.row(r);
    for (std::size_t c = 0; c < cols; ++c) to[c] = from[2 * c];
  }
}

template <class Real, class Transfer>
void transfer_vectors(const VectorField<Real>& from, VectorField<Real>& to, Transfer transfer) {
  transfer(from.x, to.x);
  transfer(from.y, to.y);
  transfer(from.z, to.z);
}

template <class Real, class Transfer>
void transfer_state(const Particles<Real>& from, Particles<Real>& to, Transfer transfer) {
  to.place = from.place;
  transfer_vectors(from.position, to.position, transfer);
  transfer_vectors(from.velocity, to.velocity, transfer);
  transfer_vectors(from.acceleration, to.acceleration, transfer);
}

}  // namespace

template <class Real>
void split(const Particles<Real>& coarse, Particles<Real>& fine) {
  require_nested(coarse.grid(), fine.grid());
  transfer_state(coarse, fine, split_field<Real>);
}

template <class Real>
void merge(const Particles<Real>& fine, Particles<Real>& coarse) {
  require_nested(coarse.grid(), fine.grid());
  transfer_state(fine, coarse, merge_field<Real>);
}

template <class Real>
void merge_momentum(const Particles<Real>& fine, Particles<Real>& coarse) {
  require_nested(coarse.grid(), fine.grid());
  const Grid& grid = fine.grid();
  for (int r = 0; r < coarse.grid().rows; ++r) {
    for (int c = 0; c < coarse.grid().cols; ++c) {
      Vec3 momentum(0, 0, 0);
      double mass = 0;
      for (int i = std::max(0, 2 * r - 1); i <= std::min(grid.rows - 1, 2 * r + 1); ++i) {
        for (int j = std::max(0, 2 * c - 1); j <= std::min(grid.cols - 1, 2 * c + 1); ++j) {
          const double share =
              (i == 2 * r ? 1.0 : 0.5) * (j == 2 * c ? 1.0 : 0.5) * double(fine.mass.at(i, j));
          momentum += share * fine.velocity_at(i, j);
          mass += share;
        }
      }
      const Vec3 velocity = momentum / mass;
      coarse.velocity.x.at(r, c) = static_cast<Real>(velocity.x());
      coarse.velocity.y.at(r, c) = static_cast<Real>(velocity.y());
      coarse.velocity.z.at(r, c) = static_cast<Real>(velocity.z());
    }
  }
}

template <class Real>
void mass_distribution(double total_mass, Discretization discretization, Field<Real>& mass) {
  const Grid& grid = mass.grid();
  const bool by_area = discretization == Discretization::continuum;
  // Halves and quarters of one value: their sum is exactly that value times the number of cells, and cells
  // are quartered from level to level, so that no level loses a bit.
  const auto whole = static_cast<Real>(total_mass / (by_area ? grid.cells() : grid.nodes()));
  for (int r = 0; r < grid.rows; ++r) {
    const bool row_border = by_area && (r == 0 || r == grid.rows - 1);
    for (int c = 0; c < grid.cols; ++c) {
      const bool col_border = by_area && (c == 0 || c == grid.cols - 1);
      mass.at(r, c) = whole * (row_border ? Real(0.5) : Real(1)) * (col_border ? Real(0.5) : Real(1));
    }
  }
}

template void split<float>(const Particles<float>&, Particles<float>&);
template void split<double>(const Particles<double>&, Particles<double>&);
template void merge<float>(const Particles<float>&, Particles<float>&);
template void merge<double>(const Particles<double>&, Particles<double>&);
template void merge_momentum<float>(const Particles<float>&, Particles<float>&);
template void merge_momentum<double>(const Particles<double>&, Particles<double>&);
template void mass_distribution<float>(double, Discretization, Field<float>&);
template void mass_distribution<double>(double, Discretization, Field<double>&);

}  // namespace weft
