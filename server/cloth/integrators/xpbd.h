#pragma once
#include "cloth/integrators/integrator.h"
#include "cloth/integrators/sheet_projection.h"
#include "cloth/integrators/substep_refinement.h"

namespace weft {

/// Substeps of a step of `dt` seconds in motion that is not violent. Where they are chosen by their length a
/// tenth of one is spread over the others: time steps are given rounded, and 0.0167 s is meant as 1/60 s.
int substeps(const XpbdDescription& description, double dt);

/// Extended position-based dynamics with small steps (Macklin, Mueller, Chentanez 2016, "XPBD"; Macklin et
/// al. 2019, "Small steps in physics simulation"). Each substep moves the nodes by Eq. 6 under the effects
/// alone, then projects every spring once as a distance constraint of compliance 1/k, then takes the
/// velocities from the positions; then section 2.4's collisions.
///
/// Bounded for any stiffness and substep. What more substeps buy is accuracy: a spring that carries a load F
/// between nodes of masses m_i, m_j is left up to F h^2 (1/m_i + 1/m_j) longer than F/k says. Over the N
/// cells of a sheet hung by its edge that adds up to about g h^2 N^2 / 2.
///
/// A sheet in violent motion, struck, or blown up has up to 4 times the substeps (substep_refinement.h).
///
/// A plate's stencils are softer than asked for where the plate's stiffest modes are much faster than the
/// substeps.
template <class Real>
class Xpbd final : public Integrator<Real> {
 public:
  explicit Xpbd(const XpbdDescription& description) : description_(description) {}
  const char* name() const override { return XpbdDescription::kName; }
  AdvanceReport advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                        std::vector<Solid>& solids, double time, double dt) override;
  void restart() override {
    force_ = rounded_off_ = {};
    projection_.restart();
    refinement_.restart();
    times_ = 1;
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(refinement_, times_, rounded_off_, sheet_, projection_);
    if (Archive::is_loading::value && rounded_off_.grid().rows > 0) lay_out(rounded_off_.grid());
  }

 private:
  /// Lays out the work arrays for these particles, and the sheet for substeps of h seconds.
  void prepare(const Particles<Real>& particles, const Forces<Real>& forces, double h);
  void lay_out(const Grid& grid);
  /// Takes the nodes of moving pins back by `share` of their way in the substep, which makes it their move.
  void take_back_pins(const Forces<Real>& forces, double share, double h);
  void substep(Particles<Real>& particles, const Forces<Real>& forces, double force_share, double h);

  XpbdDescription description_;
  SubstepRefinement<Real> refinement_;
  int times_ = 1;  ///< so many times the described substeps had the last step
  VectorField<Real> force_, rounded_off_;
  kernels::QuarterRows layout_;
  std::vector<Real, AlignedAllocator<Real>> sheet_;  ///< the nodes in that layout
  std::vector<Real, AlignedAllocator<Real>> row_;    ///< one row in the particles' own order
  SheetProjection<Real> projection_;
};

extern template class Xpbd<float>;
extern template class Xpbd<double>;

}  // namespace weft
