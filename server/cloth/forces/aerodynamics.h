#pragma once
#include "cloth/forces/effect.h"

namespace weft {

/// Drag and lift of every face from the relative velocity; AerodynamicsEffect has the equation. Faces are
/// flat plates, each in undisturbed air (Wejchert and Haumann, Animation Aerodynamics, 1991): none is in the
/// lee of another. A plate across the flow has a coefficient of about 1.2 (Hoerner, Fluid-Dynamic Drag,
/// 1965).
///
/// The implicit methods' systems have its damping and leave out how it turns with the faces, which is not
/// symmetric and not positive definite: each iteration has the force of its own iterate.
template <class Real>
class Aerodynamics final : public Effect<Real> {
 public:
  explicit Aerodynamics(const AerodynamicsEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return AerodynamicsEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;
  void add_damping(const Particles<Real>& particles, const EffectContext& context,
                   const DampingMatrix<Real>& damping) const override;
  /// By the cells' area at rest.
  double tension(const Particles<Real>& particles, const EffectContext& context) const override;
  bool feels_wind() const override { return true; }
  bool slow() const override { return true; }
  bool needs_blocks() const override { return true; }
  bool drives(const EffectContext& context) const override { return context.has_wind(); }

 private:
  /// The largest |w.A| of a face, m3/s.
  double max_flow(const Particles<Real>& particles, const EffectContext& context) const;
  /// Damping rate, 1/s, that a flow |w.A| of 1 m3/s through every face gives a node.
  double rate_per_flow(const Particles<Real>& particles) const;

  AerodynamicsEffect parameters_;
};

extern template class Aerodynamics<float>;
extern template class Aerodynamics<double>;

}  // namespace weft
