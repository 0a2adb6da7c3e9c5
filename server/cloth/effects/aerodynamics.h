#pragma once
#include "cloth/effects/effect.h"

namespace weft {

/// Flat-plate pressure per face from the relative velocity; see AerodynamicsEffect.
template <class Real>
class Aerodynamics final : public Effect<Real> {
 public:
  explicit Aerodynamics(const AerodynamicsEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return AerodynamicsEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;

 private:
  AerodynamicsEffect parameters_;
};

extern template class Aerodynamics<float>;
extern template class Aerodynamics<double>;

}  // namespace weft
