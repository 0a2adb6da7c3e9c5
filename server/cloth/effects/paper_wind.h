#pragma once
#include "cloth/effects/effect.h"

namespace weft {

/// Eq. 4, F = lambda N; see PaperWindEffect.
template <class Real>
class PaperWind final : public Effect<Real> {
 public:
  explicit PaperWind(const PaperWindEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return PaperWindEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  bool feels_wind() const override { return true; }

 private:
  PaperWindEffect parameters_;
};

extern template class PaperWind<float>;
extern template class PaperWind<double>;

}  // namespace weft
