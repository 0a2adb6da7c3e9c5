#pragma once
#include "cloth/forces/effect.h"

namespace weft {

/// Eq. 4, F = lambda N; see PaperWindEffect.
///
/// The implicit methods' systems have nothing of it: along the wind it hangs on no position, and how it turns
/// with the cloth's normals is neither symmetric nor positive definite, and small beside the springs. Each
/// iteration has the force of its own iterate.
template <class Real>
class PaperWind final : public Effect<Real> {
 public:
  explicit PaperWind(const PaperWindEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return PaperWindEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  bool feels_wind() const override { return true; }
  bool drives(const EffectContext& context) const override { return context.has_wind(); }

 private:
  PaperWindEffect parameters_;
};

extern template class PaperWind<float>;
extern template class PaperWind<double>;

}  // namespace weft
