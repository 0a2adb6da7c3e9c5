#include "engines/baseline_engine.h"

#include "cloth/integrators/symplectic_euler.h"

namespace weft::bench {
namespace {

SimulationDescription describe_paper(const EngineScene& scene, double structural) {
  SimulationDescription description = describe(scene, structural, SymplecticEulerDescription{});
  ClothDescription& cloth = description.cloths[0];
  cloth.discretization = Discretization::paper;
  const double node_mass = kDensity * kSheetSide * kSheetSide / (scene.side() * scene.side());
  cloth.material.damping = scene.damping * node_mass;
  for (EffectDescription& effect : description.effects) {
    if (!std::holds_alternative<AerodynamicsEffect>(effect)) continue;
    constexpr double kWindAcceleration = 10;  // m/s2
    effect = PaperWindEffect{kWindAcceleration * node_mass / kWindSpeed, false};
  }
  return description;
}

}  // namespace

int BaselineEngine::substeps(const EngineScene& scene, double structural) {
  const SimulationDescription description = describe_paper(scene, structural);
  const Simulation<double> simulation(description);
  const Cloth<double>& cloth = simulation.cloths()[0];
  return stable_substeps(cloth.springs().max_squared_frequency(cloth.particles().mass), scene.damping,
                         kFrameTime, SymplecticEulerDescription{}.safety);
}

BaselineEngine::BaselineEngine(const EngineScene& scene, double structural)
    : side_(scene.side()),
      baseline_(Simulation<float>(describe_paper(scene, structural)), substeps(scene, structural)) {}

void BaselineEngine::read(SheetState& sheet) const {
  const auto vec3 = [](const Vector<float>& v) { return Vec3(double(v.x), double(v.y), double(v.z)); };
  sheet.side = side_;
  sheet.position.clear();
  sheet.velocity.clear();
  for (const Particle<float>& particle : baseline_.particles()) {
    sheet.position.push_back(vec3(particle.position));
    sheet.velocity.push_back(particle.pinned ? Vec3(0, 0, 0) : vec3(particle.velocity));
  }
}

}  // namespace weft::bench
