#pragma once
/// One sheet under one integrator, without the scene around it.
#include <memory>
#include <optional>
#include <utility>

#include "cloth/integrators/integrator.h"
#include "fixtures.h"

namespace weft::test {

/// tau of the effect strain_damping, s; 0 where it is not listed.
inline double damping_time(const std::vector<EffectDescription>& listed) {
  for (const EffectDescription& effect : listed) {
    if (const auto* damping = std::get_if<StrainDampingEffect>(&effect)) return damping->time;
  }
  return 0;
}

template <class Description>
bool lists(const std::vector<EffectDescription>& listed) {
  return std::any_of(listed.begin(), listed.end(), [](const EffectDescription& effect) {
    return std::holds_alternative<Description>(effect);
  });
}

/// A sheet, its springs and effects, stepped by the integrator alone. A plate is clamped where the sheet is
/// held when it is handed over.
template <class Real>
struct Rig {
  ClothDescription cloth;
  Wind wind;
  std::vector<Solid> solids;
  Particles<Real> particles;
  Springs<Real> springs;
  std::optional<Plate<Real>> plate;
  std::vector<std::unique_ptr<Effect<Real>>> effects;
  std::unique_ptr<Integrator<Real>> integrator;

  Rig(Particles<Real> sheet, const Vec2& size, const Material& material, Discretization discretization,
      const std::vector<EffectDescription>& listed, const IntegratorDescription& stepping)
      : particles(std::move(sheet)),
        springs(material, discretization, size, particles.grid(), damping_time(listed),
                lists<StrainLimitEffect>(listed)),
        effects(make_effects<Real>(listed)),
        integrator(make_integrator<Real>(stepping)) {
    cloth.size = size;
    cloth.material = material;
    cloth.discretization = discretization;
    if (lists<PlateBendingEffect>(listed)) plate.emplace(material.rigidity, size, particles.inverse_mass);
  }
  Forces<Real> forces(double time) const {
    return {&springs, &effects, {&cloth, &wind, time}, nullptr, plate ? &*plate : nullptr};
  }
  AdvanceReport advance(double time, double dt) {
    return integrator->advance(particles, forces(time), nullptr, solids, time, dt);
  }
};

/// A square sheet of 2 m in the x-y plane, 0.4 kg, shared as the continuum has it.
template <class Real>
Rig<Real> sheet_rig(int rows, int cols, const IntegratorDescription& stepping,
                    const std::vector<EffectDescription>& effects = {}, const Material& material = {}) {
  Particles<Real> sheet = flat_sheet<Real>(rows, cols, {2, 2});
  share_mass(sheet, 0.4, Discretization::continuum);
  return {std::move(sheet), {2, 2}, material, Discretization::continuum, effects, stepping};
}

/// The same, held by its upper corners.
template <class Real>
Rig<Real> hung_rig(int rows, int cols, const IntegratorDescription& stepping,
                   const std::vector<EffectDescription>& effects = {}, const Material& material = {}) {
  Rig<Real> rig = sheet_rig<Real>(rows, cols, stepping, effects, material);
  for (int c : {0, cols - 1}) rig.particles.inverse_mass.at(0, c) = 0;
  return rig;
}

inline Material without_springs() {
  Material material;
  material.structural = material.shear = material.bending = 0;
  return material;
}

}  // namespace weft::test
