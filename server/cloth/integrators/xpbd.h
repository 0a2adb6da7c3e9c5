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
/// Soft pins (soft_pins.h) are implicit, so that any stiffness is stable: a spring k that draws a node of
/// mass m to p adds k / 2 |x - p|^2 to the m / (2 h^2) |x - x~|^2 that inertia asks for (Macklin et al. 2016,
/// Eq. 5), and both are least together, but for a constant, as a mass m + k h^2 that is predicted at (m x~ +
/// k h^2 p) / (m + k h^2). All projections find that mass, and the pin carries all that they ask of it.
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
  /// Gives the nodes of soft pins the masses that they have in substeps of h seconds.
  void prepare_soft_pins(const SoftPins<Real>& pins, double h);
  /// Moves them from where they were predicted towards their places at `time`, s, the substep's end.
  void draw_to_soft_pins(const SoftPins<Real>& pins, const Vec3& place, double time);
  /// Of the node, in `sheet_`: x where the substep began; the other fields follow by layout_.stride.
  Real* lane_of(std::size_t node);
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
  std::vector<double> soft_shares_;  ///< of soft pins: the share of a node's way to its place, in their order
};

extern template class Xpbd<float>;
extern template class Xpbd<double>;

}  // namespace weft
