#pragma once
#include <memory>
#include <vector>

#include "cloth/air/bag.h"
#include "cloth/contact/constraints/layer_contacts.h"
#include "cloth/forces/effect.h"
#include "cloth/forces/soft_pins.h"
#include "cloth/sheet/pins.h"
#include "cloth/sheet/sheet.h"

namespace weft {

/// Bounds on the damping rate of a cloth's effects together, 1/s (Effect::max_damping_rate).
struct DampingRates {
  double slow = 0;  ///< of those that are slow (Effect::slow)
  double other = 0;
  double sum() const { return slow + other; }
};

/// What may do work on a cloth, besides gravity and what takes energy only.
enum class Drive {
  nothing,
  wind,  ///< an effect that feels it
  other  ///< hands, pins, bodies, gas, other cloth
};

/// Everything that pushes one cloth, at one level.
template <class Real>
struct Forces {
  const Sheet<Real>* sheet = nullptr;
  const std::vector<std::unique_ptr<Effect<Real>>>* effects = nullptr;
  EffectContext context;
  const Pins<Real>* pins = nullptr;       ///< if any of them moves
  SoftPins<Real>* soft_pins = nullptr;    ///< the one among the effects, if some hold
  LayerContacts<Real>* layers = nullptr;  ///< if layers of cloth lie near one another in this step
  std::size_t part = 0;                   ///< of the layers, this cloth
  bool layered = false;                   ///< some may, in the scene
  Bag<Real>* bag = nullptr;               ///< of a sewn cloth
  Drive drive = Drive::other;             ///< what may do work on the cloth in this step
  bool disturbed = false;                 ///< something may have given it energy since the last step
  /// The step guard has backward Euler rescue the cloth: in as long substeps as it asks for, as they damp.
  bool rescued = false;

  /// Puts moving pins where they are at `time`, s: at a substep's begin, where they are at its end.
  void carry_pins(Particles<Real>& particles, double time) const {
    if (pins != nullptr) pins->carry(particles, time);
  }
  /// Calls visit(node, way) for the nodes of moving pins, which carry_pins leaves without a velocity: their
  /// way from `begin` to `end`, s, in m.
  template <class Visit>
  void for_each_pin_way(double begin, double end, Visit visit) const {
    if (pins != nullptr) pins->for_each_way(begin, end, visit);
  }

  /// Makes one of what a seam joins.
  void join(Particles<Real>& particles) const {
    if (bag != nullptr) bag->join(particles);
  }
  /// Explicit methods: ends a substep of h seconds to `time` of a sewn cloth (Bag::close).
  void close(Particles<Real>& particles, double time, double h) const {
    if (bag != nullptr) bag->close(particles, time, h);
  }
  bool holds_gas() const { return bag != nullptr && bag->gas() != nullptr; }

  /// Eq. 5: F_sum = F_elastic + the scene's effects; `force` is overwritten, N. The sheet's damping, which
  /// each method takes in its own way, is not in it.
  void sum(const Particles<Real>& particles, VectorField<Real>& force) const;
  /// The same with `slow`, N, in place of the slow effects (Effect::slow), and these alone; `force` is
  /// overwritten, N.
  void sum_with(const VectorField<Real>& slow, const Particles<Real>& particles,
                VectorField<Real>& force) const;
  void sum_slow(const Particles<Real>& particles, VectorField<Real>& force) const;
  /// The scene's effects alone, without `other`, which the method takes in its own way; `force` is
  /// overwritten, N.
  void sum_effects(const Particles<Real>& particles, VectorField<Real>& force,
                   const Effect<Real>* other = nullptr) const;
  /// Of motion, sheet, and of the effects that have one, J.
  double energy(const Particles<Real>& particles) const;
  /// Of the effects that have one, J: of height.
  double effects_energy(const Particles<Real>& particles) const;
  bool any_slow() const;
  DampingRates max_damping_rates(const Particles<Real>& particles, const Effect<Real>* other = nullptr) const;
  /// What the sheet needs to hold all that the effects do, N/m, at most.
  double tension(const Particles<Real>& particles) const;

  /// Implicit methods: how far the energy of sheet and gas after `change` is from what their linearisation at
  /// `position` promised.
  kernels::SpringModelError model_error(const Grid& grid, kernels::Components<const Real> position,
                                        kernels::Components<const Real> change) const;
};

extern template struct Forces<float>;
extern template struct Forces<double>;

}  // namespace weft
