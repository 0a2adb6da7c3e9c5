#pragma once
/// Faults for the tests of the step guard: an effect that goes wrong as it is told.
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cloth/world/simulation.h"

namespace weft::test {

/// Calls `spoil` with the time, s, and the force to be spoilt, N.
template <class Real>
class FaultyEffect final : public Effect<Real> {
 public:
  using Spoil = std::function<void(double, VectorField<Real>&)>;
  explicit FaultyEffect(Spoil spoil) : spoil_(std::move(spoil)) {}
  const char* name() const override { return "fault"; }
  void add_forces(const Particles<Real>&, const EffectContext& context,
                  VectorField<Real>& force) const override {
    spoil_(context.time, force);
  }

 private:
  Spoil spoil_;
};

template <class Real>
void add_fault(Cloth<Real>& cloth, typename FaultyEffect<Real>::Spoil spoil) {
  cloth.add_effect(std::make_unique<FaultyEffect<Real>>(std::move(spoil)));
}

template <class Real>
inline constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();

/// Every integrator with the settings it has when nothing is said.
inline std::vector<IntegratorDescription> default_integrators() {
  return {SymplecticEulerDescription{}, XpbdDescription{}, BackwardEulerDescription{}, Bdf2Description{}};
}

inline const char* name_of(const IntegratorDescription& integrator) {
  return std::visit([](const auto& each) { return each.kName; }, integrator);
}

}  // namespace weft::test
