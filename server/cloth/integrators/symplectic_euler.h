#pragma once
#include "cloth/integrators/energy_bound.h"
#include "cloth/integrators/integrator.h"

namespace weft {

/// Substeps for which v += a h, r += v h is stable for a mode of squared frequency w2 (1/s2) and damping rate
/// c (1/s): the smallest n with w2 h^2 + 2 c h <= 4 safety^2, h = dt / n (from the roots of z^2 - (2 - c h -
/// w2 h^2) z + 1 - c h). At least 1, at most kMaxSubsteps.
int stable_substeps(double squared_frequency, double damping_rate, double dt, double safety);
inline constexpr int kMaxSubsteps = 10000;

/// Eq. 6 in the paper's order: a = F/m, then v += a h, then r += v h with the new v; then section 2.4's
/// collisions.
///
/// Where it chooses the substeps itself, slow effects (Effect::slow) are found once for several of them. What
/// has lasted of them is spread over these substeps, and the rest, drag above all, is given at one blow in
/// their midst: the impulse method of Tuckerman, Berne and Martyna (Reversible multiple time scale molecular
/// dynamics, 1992), which would have a taut sheet in a steady wind ring if all of it came in blows. And there
/// are more substeps than the stiffest mode asks for while springs may turn over.
///
/// Positions rounded in every substep shake the stiff springs; of a cloth that nothing drives the energy
/// stays what it was all the same (EnergyBound).
template <class Real>
class SymplecticEuler final : public Integrator<Real> {
 public:
  explicit SymplecticEuler(const SymplecticEulerDescription& description) : description_(description) {}
  const char* name() const override { return SymplecticEulerDescription::kName; }
  AdvanceReport advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                        std::vector<Solid>& solids, double time, double dt) override;
  void restart() override {
    refinement_ = 1;
    bound_ = {};
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(refinement_, bound_);
  }

 private:
  struct Plan {
    int substeps;
    double damping_limit;  ///< 1/s (EffectContext)
    bool stable;
    int together = 1;  ///< substeps for which slow effects are found once
  };
  /// Of a step of dt seconds.
  Plan plan(const Particles<Real>& particles, const Forces<Real>& forces, double dt);
  /// How many times the substeps of h seconds that stable_substeps asks for are to be made while springs move
  /// like this; `frequency` is that of their stiffest mode, 1/s. A power of two, kept until a quarter would
  /// do: each change of the substeps changes what symplectic Euler keeps instead of the energy.
  int refinement(const kernels::SpringMotion& most, double frequency, double h);

  /// What the sheet's damping does in a substep of h seconds that begins at forces.context.time.
  void add_damping(Particles<Real>& particles, const Forces<Real>& forces, double h);

  /// Slow effects' force, which acts for so many seconds.
  void find_slow(const Particles<Real>& particles, Forces<Real> forces, double seconds);
  /// In the midst of so many substeps of h seconds; force_ is the sum.
  void blow(Particles<Real>& particles, const Forces<Real>& forces, double h, int together);

  SymplecticEulerDescription description_;
  int refinement_ = 1;  ///< of the step before
  EnergyBound<Real> bound_;
  VectorField<Real> force_;
  /// Slow effects: what they do now, what of it has lasted; and velocities. Empty unless blows are given.
  VectorField<Real> slow_, lasting_, velocity_;
};

extern template class SymplecticEuler<float>;
extern template class SymplecticEuler<double>;

}  // namespace weft
