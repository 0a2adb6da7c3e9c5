#pragma once
#include <optional>

#include "cloth/colliders.h"
#include "cloth/integrators/integrator.h"

namespace weft {

/// One cloth: its particles at their present level, and all that belongs to that level.
template <class Real>
class Cloth {
 public:
  /// `seed` makes the start's random offsets.
  Cloth(const ClothDescription& description, const std::vector<EffectDescription>& effects,
        const IntegratorDescription& integrator, std::uint64_t seed);

  const ClothDescription& description() const { return description_; }
  int level() const { return level_; }
  const Particles<Real>& particles() const { return particles_; }
  Particles<Real>& particles() { return particles_; }
  const Springs<Real>& springs() const { return springs_; }
  double total_mass() const { return total_mass_; }  ///< kg; the same at every level
  ContactCounters contact_counters() const;

  /// Asks for a level, clamped to the cloth's own limits; it is reached before the next step.
  void request_level(int level);
  /// Splits or merges, one level at a time, to the requested level (Eqs. 8, 9); true if the level changed.
  bool apply_pending_level();

  /// The next advance() is by `integrator`, which knows nothing of the steps before.
  void set_integrator(const IntegratorDescription& integrator) {
    integrator_ = make_integrator<Real>(integrator);
  }

  /// One step among the solids as they move in it; what the cloth gives them is kept, and theirs with
  /// push_balls(). Several cloths may do it at the same time.
  AdvanceReport advance(const std::vector<Solid>& solids, const Wind& wind, double time, double dt);
  /// Hands over the impulses of the last advance.
  void push_balls(Colliders& colliders) const;

 private:
  void enter_level(int level, Particles<Real> particles);

  ClothDescription description_;
  double total_mass_ = 0;
  int level_ = 0;
  std::optional<int> pending_level_;
  Particles<Real> particles_;
  Pins<Real> pins_;
  double time_ = 0;  ///< s, at the end of the last step
  Springs<Real> springs_;
  std::vector<std::unique_ptr<Effect<Real>>> effects_;
  std::unique_ptr<Integrator<Real>> integrator_;
  std::unique_ptr<Contact<Real>> contact_;  ///< made when the scene first has a solid
  ContactCounters earlier_contacts_;        ///< at the levels left behind
};

extern template class Cloth<float>;
extern template class Cloth<double>;

}  // namespace weft
