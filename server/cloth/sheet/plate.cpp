#include "cloth/sheet/plate.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// How much of a moment a node between two neighbours bears. A cell's width bends there with the curvature of
/// the two cells beside it; where one of these is held flat the curvature is all in the other half, which is
/// twice as stiff.
template <class Real>
double clamp_factor(Real before, Real here, Real after) {
  const bool clamped = here == Real(0) && (before == Real(0)) != (after == Real(0));
  return clamped ? 2.0 : 1.0;
}

}  // namespace

template <class Real>
Plate<Real>::Plate(const Rigidity& rigidity, const Vec2& size, const Field<Real>& inverse_mass,
                   const TornLinks* torn)
    : rigidity_(rigidity),
      size_(size),
      free_(inverse_mass.grid()),
      u_(free_.grid()),
      v_(free_.grid()),
      twist_(free_.grid()),
      smoother_(free_.grid()),
      work_(kernels::plate_work_size(free_.grid()), Real(0)) {
  const int rows = grid().rows, cols = grid().cols;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) free_.at(r, c) = inverse_mass.at(r, c) > Real(0) ? Real(1) : Real(0);
  }
  const double hx = size.x() / (cols - 1), hy = size.y() / (rows - 1);
  // Of the rigidity times the area a stencil stands for, over the fourth power of the spacing it spans.
  const double u = rigidity.u * hy / (hx * hx * hx), v = rigidity.v * hx / (hy * hy * hy);
  const double twist = 2 * rigidity.twist / (hx * hy);
  for (int r = 0; r < rows; ++r) {
    const bool inner_row = r > 0 && r + 1 < rows;
    for (int c = 0; c < cols; ++c) {
      const bool inner_col = c > 0 && c + 1 < cols;
      if (inner_col) {
        const double share = inner_row ? 1.0 : 0.5;
        u_.at(r, c) = static_cast<Real>(u * share *
                                        clamp_factor(free_.at(r, c - 1), free_.at(r, c), free_.at(r, c + 1)));
      }
      if (inner_row) {
        const double share = inner_col ? 1.0 : 0.5;
        v_.at(r, c) = static_cast<Real>(v * share *
                                        clamp_factor(free_.at(r - 1, c), free_.at(r, c), free_.at(r + 1, c)));
      }
      if (r + 1 < rows && c + 1 < cols) twist_.at(r, c) = static_cast<Real>(twist);
    }
  }
  if (torn != nullptr) leave_out(*torn);
  for_each_stencil([&](double stiffness, const auto& nodes) {
    // (sum a_i x_i)^2 <= sum |a_j| sum |a_i| x_i^2, and sum |a_j| = 4 for every stencil.
    for (const StencilNode& node : nodes) {
      smoother_.at(node.row, node.col) += static_cast<Real>(2 * stiffness * std::abs(node.weight));
    }
  });
}

template <class Real>
void Plate<Real>::leave_out(const TornLinks& torn) {
  for (int r = 0; r < grid().rows; ++r) {
    for (int c = 0; c < grid().cols; ++c) {
      const auto clear = [&](Field<Real>& stiffness, bool gone) {
        if (gone) stiffness.at(r, c) = Real(0);
      };
      clear(u_, c > 0 && c + 1 < grid().cols && torn.torn(r, c - 1, 0, 2));
      clear(v_, r > 0 && r + 1 < grid().rows && torn.torn(r - 1, c, 2, 0));
      clear(twist_, r + 1 < grid().rows && c + 1 < grid().cols && torn.face_torn(r, c));
    }
  }
}

template <class Real>
void Plate<Real>::add_forces(const VectorField<Real>& position, VectorField<Real>& force) const {
  kernels::subtract_plate<Real>(stencils(), grid(), kernels::components(position), free_.row(0),
                                kernels::components(force), {0, grid().rows}, work_.data());
}

template <class Real>
double Plate<Real>::energy(const VectorField<Real>& position) const {
  double sum = 0;
  for_each_stencil([&](double stiffness, const auto& nodes) {
    Vec3 difference = Vec3::Zero();
    for (const StencilNode& node : nodes) {
      difference += node.weight * Vec3(double(position.x.at(node.row, node.col)),
                                       double(position.y.at(node.row, node.col)),
                                       double(position.z.at(node.row, node.col)));
    }
    sum += stiffness * difference.squaredNorm() / 2;
  });
  return sum;
}

template <class Real>
double Plate<Real>::max_squared_frequency(const Field<Real>& mass) const {
  double most = 0;
  for (int r = 0; r < grid().rows; ++r) {
    for (int c = 0; c < grid().cols; ++c) {
      most = std::max(most, 2 * double(smoother_.at(r, c)) / double(mass.at(r, c)));
    }
  }
  return most * (1 + 1e-6);  // room for rounding
}

template <class Real>
Plate<Real> Plate<Real>::coarser() const {
  Field<Real> free(Grid::with_nodes((grid().rows + 1) / 2, (grid().cols + 1) / 2));
  for (int r = 0; r < free.grid().rows; ++r) {
    for (int c = 0; c < free.grid().cols; ++c) free.at(r, c) = free_.at(2 * r, 2 * c);
  }
  return Plate(rigidity_, size_, free);
}

template class Plate<float>;
template class Plate<double>;

}  // namespace weft
