#pragma once
#include "cloth/forces/effect.h"

namespace weft {

/// Eq. 3, F = -k v, k = Material::damping per particle (paper) or per area (continuum: k times the area the
/// node represents).
template <class Real>
class Damping final : public Effect<Real> {
 public:
  explicit Damping(const DampingEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return DampingEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;
  void add_damping(const Particles<Real>& particles, const EffectContext& context,
                   const DampingMatrix<Real>& damping) const override;
  bool drives(const EffectContext&) const override { return false; }

 private:
  DampingEffect parameters_;
};

extern template class Damping<float>;
extern template class Damping<double>;

}  // namespace weft
