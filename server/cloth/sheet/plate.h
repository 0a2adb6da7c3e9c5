#pragma once
#include <array>

#include "cloth/core/particles.h"
#include "cloth/kernels/plate_kernels.h"
#include "cloth/sheet/material.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// The bending of one cloth at one level: the energy of a plate (Landau and Lifshitz, Theory of Elasticity,
/// 1986, section 11), with its curvatures taken from second differences of the positions r(u, v) of the
/// sheet, which for a sheet that does not stretch are normal to it (Bergou et al., A Quadratic Bending Model
/// for Inextensible Surfaces, 2006):
///   E = integral of B_u |r_uu|^2 / 2 + B_v |r_vv|^2 / 2 + B_t |r_uv|^2.
/// Quadratic in the positions: the force -K r is linear, with one constant scalar between two nodes. No force
/// on a flat sheet wherever it is; linear and angular momentum are kept.
///
/// Borders are free (no moment, no force). Held nodes in one line are a hinge; where the sheet leaves two or
/// more in a row it is clamped, in the direction they have.
template <class Real>
class Plate {
 public:
  /// `size` is the cloth's width and height, m; nodes of inverse mass 0 are held. Where the sheet is torn it
  /// bears no moment; nullptr: it is whole.
  Plate(const Rigidity& rigidity, const Vec2& size, const Field<Real>& inverse_mass,
        const TornLinks* torn = nullptr);

  const Grid& grid() const { return free_.grid(); }
  /// Adds its force on every free node, N.
  void add_forces(const VectorField<Real>& position, VectorField<Real>& force) const;
  /// J.
  double energy(const VectorField<Real>& position) const;
  /// A bound on the largest eigenvalue of M^-1 K, 1/s2: the squared angular frequency of the stiffest mode;
  /// away from the border its own.
  double max_squared_frequency(const Field<Real>& mass) const;

  kernels::PlateStencils<Real> stencils() const { return {u_.row(0), v_.row(0), twist_.row(0)}; }
  /// D with K <= 2 D, at every node: what block Jacobi divides by, N/m.
  const Field<Real>& smoother() const { return smoother_; }
  /// The same sheet, whole, on every second node, with the nodes held that are so here. For grids of odd rows
  /// and columns.
  Plate coarser() const;

  /// A node of a stencil; the difference that a stencil resists is the sum of weight times position.
  struct StencilNode {
    int row, col;
    double weight;
  };
  /// Calls visit(stiffness, nodes) for every stencil; three in line end with a fourth node of weight 0.
  template <class Visit>
  void for_each_stencil(Visit visit) const;

 private:
  void leave_out(const TornLinks& torn);

  Rigidity rigidity_;
  Vec2 size_;
  Field<Real> free_;  ///< 1, or 0 where held
  Field<Real> u_, v_, twist_, smoother_;
  mutable std::vector<Real, AlignedAllocator<Real>> work_;  ///< no state, but one owner at a time
};

template <class Real>
template <class Visit>
void Plate<Real>::for_each_stencil(Visit visit) const {
  using Nodes = std::array<StencilNode, 4>;
  for (int r = 0; r < grid().rows; ++r) {
    for (int c = 0; c < grid().cols; ++c) {
      const auto call = [&](const Field<Real>& stiffness, const Nodes& nodes) {
        if (stiffness.at(r, c) > Real(0)) visit(double(stiffness.at(r, c)), nodes);
      };
      call(u_, {{{r, c - 1, 1}, {r, c, -2}, {r, c + 1, 1}, {r, c, 0}}});
      call(v_, {{{r - 1, c, 1}, {r, c, -2}, {r + 1, c, 1}, {r, c, 0}}});
      call(twist_, {{{r, c, 1}, {r, c + 1, -1}, {r + 1, c, -1}, {r + 1, c + 1, 1}}});
    }
  }
}

extern template class Plate<float>;
extern template class Plate<double>;

}  // namespace weft
