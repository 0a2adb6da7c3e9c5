#include "cloth/sheet/sheet.h"

#include <variant>

namespace weft {
namespace {

/// In substeps. Where a spring passes its limit its frequency jumps, and with it what symplectic Euler keeps
/// instead of the energy: without damping a sheet that rings about its limits gains without bound. With this
/// much a sheet let go at 1.055 or 1.1 times its size, limit 1.05, never has more than it began with (20 s).
constexpr double kLimitDamping = 0.25;

}  // namespace

SheetEffects::SheetEffects(const std::vector<EffectDescription>& effects) {
  for (const EffectDescription& effect : effects) {
    if (const auto* damping = std::get_if<StrainDampingEffect>(&effect)) damping_time = damping->time;
    bends_plate = bends_plate || std::holds_alternative<PlateBendingEffect>(effect);
    limits_strain = limits_strain || std::holds_alternative<StrainLimitEffect>(effect);
  }
}

template <class Real>
Sheet<Real>::Sheet(const ClothDescription& cloth, const SheetEffects& effects,
                   const Field<Real>& inverse_mass, std::shared_ptr<const TornLinks> torn)
    : springs_(cloth.material, cloth.discretization, cloth.size, inverse_mass.grid(), effects.damping_time,
               effects.limits_strain) {
  if (torn) springs_.tear(torn);
  if (effects.bends_plate)
    plate_ =
        std::make_shared<const Plate<Real>>(cloth.material.rigidity, cloth.size, inverse_mass, torn.get());
}

template <class Real>
void Sheet<Real>::add_damping(const VectorField<Real>& position, const VectorField<Real>& velocity, double h,
                              VectorField<Real>& force) const {
  springs_.add_damping(position, kernels::components(velocity), force);
  springs_.add_limit_damping(position, velocity, kLimitDamping * h, force);
}

template <class Real>
ExplicitBounds Sheet<Real>::explicit_bounds(const Field<Real>& mass) const {
  const double of_springs = springs_.max_squared_frequency(mass);
  double squared = springs_.limited() ? (1 + 2 * kLimitDamping) * of_springs : of_springs;
  if (plate_) squared += plate_->max_squared_frequency(mass);
  return {squared, of_springs, springs_.max_damping_rate(mass)};
}

template class Sheet<float>;
template class Sheet<double>;

}  // namespace weft
