#pragma once
#include "cloth/forces/effect.h"

namespace weft {

/// Eq. 2, F = m g.
template <class Real>
class Gravity final : public Effect<Real> {
 public:
  explicit Gravity(const GravityEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return GravityEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  bool drives(const EffectContext&) const override { return false; }
  double energy(const Particles<Real>& particles) const override;

 private:
  GravityEffect parameters_;
};

extern template class Gravity<float>;
extern template class Gravity<double>;

}  // namespace weft
