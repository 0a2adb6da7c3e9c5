#pragma once
#include <array>
#include <vector>

#include "cloth/kernels/plate_projection_kernels.h"
#include "cloth/kernels/xpbd_kernels.h"
#include "cloth/sheet/sheet.h"

namespace weft {

/// A sheet as XPBD (xpbd.h) projects it: each spring once as a distance constraint of compliance 1/k, each of
/// a plate's stencils (plate.h) before them. Works on nodes in the kernels' own layout.
///
/// Damped springs (strain_damping) remember their multipliers from substep to substep (recall in
/// xpbd_kernels.h), and are left no longer than undamped ones. A violent motion whose nodes move by a
/// spring's length within a substep can bring in energy there: measured at level 6 with steps of 0.2 s, not
/// with 1/15 s.
///
/// Where a plate's stiffest modes turn within a substep (w h > 2) the springs' damping time is at most the
/// substep: the plate's projection, made without regard to the springs', leaves them a rate of length in
/// every substep that a longer one answers with ever larger multipliers (a flat sheet of half a metre had
/// 1e10 J).
///
/// The families are projected in a fixed order, structural springs last. Measured: fixed orders all come to
/// rest and differ little; orders that alternate or are shuffled from substep to substep shake the cloth for
/// ever, and so do corrections 1.2 times as large.
template <class Real>
class SheetProjection {
 public:
  SheetProjection() = default;
  SheetProjection(const SheetProjection&) = delete;  // its springs point into its own arrays
  SheetProjection& operator=(const SheetProjection&) = delete;

  /// For substeps of h seconds of nodes of these masses in this layout.
  void prepare(const Sheet<Real>& sheet, const Field<Real>& mass, const kernels::QuarterRows& layout,
               double h);
  /// The nodes' substeps are `ratio` times as long as those before: multipliers are forces times h^2.
  void scale_substep(Real ratio);
  /// What damped springs remember is forgotten.
  void restart() { multiplier_.clear(); }

  /// Moves the nodes by what damped springs remember, ahead of project().
  void recall(Real* nodes) const;
  void project(Real* nodes) const;

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(multiplier_, families_);
  }

 private:
  void prepare_springs(const Springs<Real>& springs, const Grid& grid, double damping_time, double h);
  /// Those of families that were there before; families without stiffness are left out of the list.
  void keep_multipliers(const std::vector<SpringFamily>& families, std::size_t sheet_lanes);

  kernels::QuarterRows layout_;
  std::vector<Real, AlignedAllocator<Real>> stiffness_;   ///< a row of lanes for each family
  std::vector<Real, AlignedAllocator<Real>> multiplier_;  ///< of damped springs: a row of lanes for each row
  std::vector<std::array<int, 2>> families_;              ///< rows and columns of those
  std::vector<kernels::XpbdSprings<Real>> springs_;
  std::vector<Real, AlignedAllocator<Real>> plate_;  ///< its stiffnesses in that layout; empty without one
};

extern template class SheetProjection<float>;
extern template class SheetProjection<double>;

}  // namespace weft
