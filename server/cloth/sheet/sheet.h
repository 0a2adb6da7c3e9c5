#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "cloth/core/effect_description.h"
#include "cloth/sheet/cloth_description.h"
#include "cloth/sheet/plate.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// What a scene's effects make of the sheet itself: those that have no Effect object of their own. Tearing is
/// not among them, as it acts between the steps (Cloth).
struct SheetEffects {
  double damping_time = 0;     ///< s (StrainDampingEffect); 0: undamped
  bool bends_plate = false;    ///< PlateBendingEffect
  bool limits_strain = false;  ///< StrainLimitEffect

  SheetEffects() = default;
  explicit SheetEffects(const std::vector<EffectDescription>& effects);
  bool operator==(const SheetEffects&) const = default;
};

/// What an explicit substep must follow.
struct ExplicitBounds {
  double squared_frequency = 0;  ///< of the sheet's stiffest mode, 1/s2, with what damps at strain limits
  double of_springs = 0;         ///< of the springs' stiffest mode alone, 1/s2
  double damping_rate = 0;       ///< largest, of the springs' damping, 1/s
};

/// The sheet of one cloth at one level, as integrators see it: all that resists its deformation. An effect of
/// the sheet is added here, and integrators need not know it; one that the scene does not list has no object
/// and is asked for once a call, outside the loops over nodes.
template <class Real>
class Sheet {
 public:
  Sheet() = default;
  /// nullptr: bends no plate.
  explicit Sheet(Springs<Real> springs, std::shared_ptr<const Plate<Real>> plate = nullptr)
      : springs_(std::move(springs)), plate_(std::move(plate)) {}
  /// Nodes of inverse mass 0 are held. `torn` is what is cut; nullptr: the sheet is whole.
  Sheet(const ClothDescription& cloth, const SheetEffects& effects, const Field<Real>& inverse_mass,
        std::shared_ptr<const TornLinks> torn = nullptr);
  /// The same sheet with other springs.
  Sheet with(Springs<Real> springs) const { return Sheet(std::move(springs), plate_); }

  const Springs<Real>& springs() const { return springs_; }
  /// nullptr where plates are not bent.
  const Plate<Real>* plate() const { return plate_.get(); }
  /// What is cut; nullptr while the sheet is whole.
  const std::shared_ptr<const TornLinks>& torn() const { return springs_.torn(); }
  /// It resists the rate of its strain.
  bool damped() const { return springs_.damping_time() > 0; }

  /// J.
  double energy(const VectorField<Real>& position) const {
    const double springs = springs_.energy(position);
    return plate_ ? springs + plate_->energy(position) : springs;
  }
  /// Adds its force on every node, N, but for what resists rates.
  void add_forces(const VectorField<Real>& position, VectorField<Real>& force) const {
    springs_.add_forces(position, force);
    if (plate_) plate_->add_forces(position, force);
  }

  /// Explicit methods. Adds what resists rates, N, in a substep of h seconds of nodes that move at
  /// `velocity`: the damping, and at strain limits as much as keeps the substeps from gaining energy there.
  void add_damping(const VectorField<Real>& position, const VectorField<Real>& velocity, double h,
                   VectorField<Real>& force) const;
  ExplicitBounds explicit_bounds(const Field<Real>& mass) const;

  /// Implicit methods. Linearises the springs (Springs::linearise); a plate is linear, and laid out in the
  /// system.
  void linearise(const Grid& grid, kernels::Components<const Real> position,
                 const kernels::LinkFamilies<kernels::SpringLinks<Real>>& links, double h) const {
    springs_.linearise(grid, position, links, h);
  }
  /// Adds what resists rates, N, of nodes that came to `position` by `way` in h seconds.
  void add_damping_of_way(const VectorField<Real>& position, kernels::Components<const Real> way, double h,
                          VectorField<Real>& force) const {
    springs_.add_damping(position, way, h, force);
  }
  /// How far its energy after `change` is from what linearise() at `position` promised.
  kernels::SpringModelError model_error(const Grid& grid, kernels::Components<const Real> position,
                                        kernels::Components<const Real> change) const {
    return springs_.model_error(grid, position, change);
  }

 private:
  Springs<Real> springs_;
  std::shared_ptr<const Plate<Real>> plate_;  ///< one owner of its work arrays at a time, as of the springs'
};

extern template class Sheet<float>;
extern template class Sheet<double>;

}  // namespace weft
