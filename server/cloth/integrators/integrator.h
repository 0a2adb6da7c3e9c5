#pragma once
#include <memory>

#include "cloth/contact/recovery/contact.h"
#include "cloth/integrators/forces.h"
#include "cloth/integrators/integrator_description.h"

namespace weft {

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
  /// J, that the step brought into the cloth, and the most that the bodies it meets and its effects could
  /// give; 0 where it brought in no more than that (BodyEnergy).
  double gained = 0, could_give = 0;
  bool sound = true;  ///< false if no next state was found: the particles' is not to be used

  /// What this and the advance after it did together.
  AdvanceReport& operator+=(const AdvanceReport& next);
  /// But for what the clock told (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(substeps, nodes_in_contact, linear_iterations, energy_lost, energy_given_back, effects_work,
            contact_took, gained, could_give, sound);
  }
};

template <class Real>
class Implicit;

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
  /// Itself if it can step several cloths together.
  virtual Implicit<Real>* implicit() { return nullptr; }
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
