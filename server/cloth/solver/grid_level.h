#pragma once
#include <optional>

#include "cloth/kernels/bands.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/sheet/plate.h"
#include "cloth/solver/node_arrays.h"

namespace weft {

/// One grid of a hierarchy (Multigrid): its matrix and the vectors of a cycle, with their storage.
template <class Real, class Links>
struct GridLevel {
  GridLevel(const Grid& grid, bool has_bending, const Plate<Real>* plate);
  GridLevel(GridLevel&&) noexcept = default;  // not to be copied: the views below point into the storage

  Bands bands;
  kernels::LinkMatrix<Real, Links> matrix;
  std::optional<Plate<Real>> plate;  ///< part of the matrix, if there is one
  bool cycles_plate = false;         ///< the plate is part of the cycle, too
  kernels::Blocks<Real> inverse;     ///< of the diagonal blocks, damped
  kernels::Components<Real> b, x, y;

  Real* diagonal() { return numbers_[0]; }
  Real* free() { return numbers_[1]; }
  /// The matrix as block Jacobi sees it: with the plate's share of the diagonal, if the plate is cycled.
  kernels::LinkMatrix<Real, Links> smoothed();
  /// Decides whether the plate is cycled, by the diagonal.
  void weigh_plate();
  /// With blocks in the diagonal, all zero, or without.
  void use_blocks(bool use);

 private:
  NodeArrays<Real> numbers_, links_, blocks_, inverse_, vectors_;
};

extern template struct GridLevel<float, kernels::SpringLinks<float>>;
extern template struct GridLevel<double, kernels::SpringLinks<double>>;
extern template struct GridLevel<float, kernels::Blocks<float>>;
extern template struct GridLevel<double, kernels::Blocks<double>>;

}  // namespace weft
