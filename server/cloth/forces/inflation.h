#pragma once
#include <cmath>

#include "cloth/forces/effect.h"

namespace weft {

/// InflationEffect, F = p A of every face, which follows it (Hibbitt, Some follower forces and load
/// stiffness, 1979). Each cell is the bilinear patch between its corners, so that on every node inside the
/// sheet the force is exactly p dV/dr, V being the volume between the sheet and whatever closes its rim:
/// where the rim is held, the potential energy is -p V.
///
/// Springs grow longer in proportion to their tension, p times the radius: of width L and stiffness Y a strip
/// has no equilibrium beyond p = 2 pi Y / L, a square sheet none beyond 2 to 2.4 Y / L (measured). It bursts,
/// and the step guard stops it. A sheet with limits (StrainLimitEffect) bears as many times more as it
/// stiffens.
///
/// The load follows the sheet as it turns. Its stiffness is not symmetric at a free rim and not positive
/// definite anywhere, so the implicit methods' systems leave it out, as they do that of wind: each iteration
/// has the force of its own iterate, and what holds an inflated sheet, its tension of p times its radius, is
/// in the system.
template <class Real>
class Inflation final : public Effect<Real> {
 public:
  explicit Inflation(const InflationEffect& parameters) : parameters_(parameters) {}
  const char* name() const override { return InflationEffect::kName; }
  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  double tension(const Particles<Real>&, const EffectContext& context) const override {
    return std::abs(parameters_.pressure) * context.cloth->size.maxCoeff();
  }

 private:
  InflationEffect parameters_;
  mutable std::vector<Real, AlignedAllocator<Real>> work_;  ///< no state, but one owner at a time
};

extern template class Inflation<float>;
extern template class Inflation<double>;

}  // namespace weft
