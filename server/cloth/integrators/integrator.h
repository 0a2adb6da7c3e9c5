#pragma once
#include <memory>

#include "cloth/air/gas.h"
#include "cloth/contact/constraints/layer_contacts.h"
#include "cloth/contact/recovery/contact.h"
#include "cloth/forces/effect.h"
#include "cloth/forces/soft_pins.h"
#include "cloth/integrators/integrator_description.h"
#include "cloth/sheet/pins.h"
#include "cloth/sheet/plate.h"
#include "cloth/sheet/seam.h"
#include "cloth/sheet/springs.h"

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
  const Springs<Real>* springs = nullptr;
  const std::vector<std::unique_ptr<Effect<Real>>>* effects = nullptr;
  EffectContext context;
  const Pins<Real>* pins = nullptr;           ///< if any of them moves
  const SoftPins<Real>* soft_pins = nullptr;  ///< the one among the effects, if some hold
  const Plate<Real>* plate = nullptr;         ///< if the scene bends plates
  LayerContacts<Real>* layers = nullptr;      ///< if layers of cloth lie near one another in this step
  bool layered = false;                       ///< some may, in the scene
  const Seam<Real>* seam = nullptr;           ///< of a sewn cloth
  Gas<Real>* gas = nullptr;                   ///< if it is shut in it
  Drive drive = Drive::other;                 ///< what may do work on the cloth in this step
  bool disturbed = false;                     ///< something may have given it energy since the last step

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

  /// Explicit methods: ends a substep of h seconds to `time` of a sewn cloth, by its seam and then its gas,
  /// whose volume an open seam would falsify.
  void close(Particles<Real>& particles, double time, double h) const {
    if (seam != nullptr) seam->join(particles);
    if (gas != nullptr) gas->push(particles, *seam, time, h);
  }

  /// Eq. 5: F_sum = F_elastic + the scene's effects; `force` is overwritten, N. The springs' damping, which
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
  /// Of motion, springs, plate, and of the effects that have one, J.
  double energy(const Particles<Real>& particles) const;
  /// Of the effects that have one, J: of height.
  double effects_energy(const Particles<Real>& particles) const;
  bool any_slow() const;
  DampingRates max_damping_rates(const Particles<Real>& particles, const Effect<Real>* other = nullptr) const;
  /// What the sheet needs to hold all that the effects do, N/m, at most.
  double tension(const Particles<Real>& particles) const;

 private:
  /// Springs and plate.
  void add_sheet(const Particles<Real>& particles, VectorField<Real>& force) const;
};

/// What one advance did.
struct AdvanceReport {
  int substeps = 0;
  int nodes_in_contact = 0;    ///< at the end of the step
  int linear_iterations = 0;   ///< of implicit methods, all substeps together
  double forces_seconds = 0;   ///< wall time
  double contact_seconds = 0;  ///< wall time
  double check_seconds = 0;    ///< wall time of the step guard
  /// J, that formula and solves took from the cloth and what was given back to its motion (EnergyLedger), or
  /// below 0 the other way round; 0 where it was not counted.
  double energy_lost = 0, energy_given_back = 0;
  /// J, that the effects, gravity among them, did on the cloth, and that contact took from it by impacts and
  /// friction; of a cloth that nothing holds or touches beside its centre of mass. 0 where not counted.
  double effects_work = 0, contact_took = 0;
  bool sound = true;  ///< false if no next state was found: the particles' is not to be used

  /// What this and the advance after it did together.
  AdvanceReport& operator+=(const AdvanceReport& next);
  /// But for what the clock told (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(substeps, nodes_in_contact, linear_iterations, energy_lost, energy_given_back, effects_work,
            contact_took, sound);
  }
};

/// Advances one whole cloth by one step. One interface for explicit, implicit and projective methods. It
/// keeps work arrays; what it remembers of earlier steps, if anything, restart() makes it forget.
template <class Real>
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual const char* name() const = 0;
  /// From `time` to `time + dt`. `contact` is nullptr when there are no solids; `solids` have begun the step,
  /// and those that yield are left as the cloth moves them.
  virtual AdvanceReport advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                                std::vector<Solid>& solids, double time, double dt) = 0;
  /// The particles were changed from outside (another level, a snapshot): the next step begins anew.
  virtual void restart() {}
  /// Springs or plate are of another stiffness: what was laid out for them is made anew, and the next step
  /// goes on from the steps before.
  virtual void stiffness_changed() {}
  /// The sheet has torn since the last step.
  virtual void torn() {}
};

template <class Real>
std::unique_ptr<Integrator<Real>> make_integrator(const IntegratorDescription& description);

}  // namespace weft
