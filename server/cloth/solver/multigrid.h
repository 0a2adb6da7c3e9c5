#pragma once
#include <optional>

#include "cloth/sheet/seam.h"
#include "cloth/solver/attached_bodies.h"
#include "cloth/solver/coarse_solver.h"
#include "cloth/solver/grid_level.h"
#include "cloth/solver/line_smoother.h"
#include "cloth/solver/node_couplings.h"

namespace weft {

/// The linear system of an implicit step, A x = b with A as in link_kernels.h, and its preconditioner: one
/// V(1,1) multigrid cycle over the nested levels (Briggs, Henson, McCormick, A Multigrid Tutorial, 2000). The
/// transfers are split's interpolation and its transpose; coarse links are means of fine ones; the finest
/// grid is smoothed along its threads (LineSmoother), coarser ones by block Jacobi; the coarsest grid is
/// solved directly. The cycle is symmetric, as conjugate gradients need it. A plate may be part of A, on
/// every level by its own rigidities; the cycle leaves it out on levels where inertia outweighs it at every
/// node. Bodies may hang on the nodes, and nodes on one another: that is part of A, but not of the
/// preconditioner.
///
/// Where a cloth is sewn the nodes of its seam's pairs move as one, on every level: x has them equal, and b
/// the mean of what pulls at the two. With P what makes them so (Seam::average) the system is P A P x = b;
/// sewn grids are all smoothed by block Jacobi, a pair by the mean of its two diagonal blocks.
template <class Real>
class Multigrid {
 public:
  /// For grids with an even number of cells on both sides; coarsens while that holds.
  Multigrid(const Grid& finest, bool has_bending, const Plate<Real>* plate = nullptr, bool sewn = false);

  const Grid& grid() const { return finest_.matrix.grid; }
  int levels() const { return 1 + static_cast<int>(coarse_.size()); }

  /// To be written before prepare(): the finest links, diagonal, free nodes and, if it is to have any,
  /// blocks. Zero at first.
  GridLevel<Real, kernels::SpringLinks<Real>>& finest() { return finest_; }
  AttachedBodies<Real>& bodies() { return bodies_; }
  NodeCouplings<Real>& couplings() { return couplings_; }
  /// A has the part stiffness g g^T, stiffness >= 0, N/m5, of a vector g, m2, that is the caller's, 0 at
  /// fixed nodes and the same at nodes that are one. Part of A, but not of its preconditioner.
  void set_rank_one(double stiffness, kernels::Components<const Real> vector);
  /// Builds the coarse matrices and all that a cycle needs.
  void prepare();

  /// y = A x; returns x . y.
  double multiply(kernels::Components<const Real> x, kernels::Components<Real> y);
  /// z = one cycle on r, an approximation of A^-1 r; returns r . z.
  double precondition(kernels::Components<const Real> r, kernels::Components<Real> z);

 private:
  using Coarse = GridLevel<Real, kernels::Blocks<Real>>;
  /// With `plate`, of the finest grid, or nullptr.
  static std::size_t work_size(const Grid& finest, const Plate<Real>* plate);
  /// Work space of a band of any level.
  Real* work(int band) { return work_.data() + static_cast<std::size_t>(band) * work_size_; }
  /// Levels are counted from the finest, 0.
  template <class Fine>
  void prepare_level(Fine& level, std::size_t index);
  template <class Fine>
  void coarsen(Fine& fine, Coarse& coarse);
  /// level.x = one sweep from zero.
  template <class Links>
  void smooth_first(GridLevel<Real, Links>& level, kernels::Components<const Real> b);
  /// z = one sweep from level.x; returns b . z.
  template <class Links>
  double smooth_last(GridLevel<Real, Links>& level, kernels::Components<const Real> b,
                     kernels::Components<Real> z);
  /// level.y = what level.x leaves of b.
  template <class Links>
  void find_residual(GridLevel<Real, Links>& level, kernels::Components<const Real> b);
  template <class Links>
  double cycle(GridLevel<Real, Links>& level, std::size_t next, kernels::Components<const Real> b,
               kernels::Components<Real> z);

  GridLevel<Real, kernels::SpringLinks<Real>> finest_;
  AttachedBodies<Real> bodies_;
  NodeCouplings<Real> couplings_;
  double rank_one_ = 0;                            ///< its stiffness, N/m5
  kernels::Components<const Real> rank_one_by_{};  ///< its vector, m2
  std::optional<LineSmoother<Real>> lines_;        ///< of the finest level, unless it is sewn
  std::vector<Coarse> coarse_;                     ///< fine to coarse
  std::vector<Seam<Real>> seams_;  ///< of all levels, fine to coarse; none where the cloth is not sewn
  std::optional<CoarseSolver<Real>> coarsest_;
  std::size_t work_size_;  ///< of a band
  std::vector<Real, AlignedAllocator<Real>> work_;
};

extern template class Multigrid<float>;
extern template class Multigrid<double>;

}  // namespace weft
