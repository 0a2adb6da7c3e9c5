#pragma once
/// One sheet under one integrator, without the scene around it.
#include <memory>
#include <utility>

#include "cloth/integrators/integrator.h"
#include "fixtures.h"

namespace weft::test {

/// A sheet, its springs and effects, stepped by the integrator alone.
template <class Real>
struct Rig {
  ClothDescription cloth;
  Wind wind;
  std::vector<Ball> balls;
  Particles<Real> particles;
  Springs<Real> springs;
  std::vector<std::unique_ptr<Effect<Real>>> effects;
  std::unique_ptr<Integrator<Real>> integrator;

  Rig(Particles<Real> sheet, const Vec2& size, const Material& material, Discretization discretization,
      const std::vector<EffectDescription>& listed, const IntegratorDescription& stepping)
      : particles(std::move(sheet)),
        springs(material, discretization, size, particles.grid()),
        effects(make_effects<Real>(listed)),
        integrator(make_integrator<Real>(stepping)) {
    cloth.size = size;
    cloth.material = material;
    cloth.discretization = discretization;
  }
  AdvanceReport advance(double time, double dt) {
    return integrator->advance(particles, {&springs, &effects, {&cloth, &wind, time}}, nullptr, balls, time,
                               dt);
  }
};

inline Material without_springs() {
  Material material;
  material.structural = material.shear = material.bending = 0;
  return material;
}

}  // namespace weft::test
