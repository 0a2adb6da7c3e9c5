#include "merges.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace weft::stability {
namespace {

/// A step of twenty crossings of a wave of stretch lets folds shift, and is short enough for Newton.
constexpr double kCrossings = 20;
constexpr int kRound = 10, kMostRounds = 50;  ///< steps between two looks at the energy, and looks
constexpr double kLittle = 1e-3;

/// The sheet alone, at rest at its level, in a scene in which nothing but its springs and plate acts.
Simulation<float> at_rest(const Simulation<float>& simulation) {
  SimulationDescription scene;
  ClothDescription cloth = simulation.cloths()[0].description();
  cloth.nodes.clear();
  cloth.perturbation = 0;
  cloth.velocity.setZero();
  cloth.initial_level = cloth.min_level = cloth.max_level = simulation.cloths()[0].level();
  for (PinRegion& pin : cloth.pins) pin = {pin.u_min, pin.u_max, pin.v_min, pin.v_max};
  if (simulation.cloths()[0].plate() != nullptr) scene.effects.push_back(PlateBendingEffect{});
  for (const EffectDescription& effect : simulation.description().effects) {
    if (std::holds_alternative<StrainLimitEffect>(effect)) scene.effects.push_back(effect);
  }
  scene.time_step = kCrossings * cloth.size.maxCoeff() *
                    std::sqrt(cloth.material.density / cloth.material.structural.least());
  scene.cloths = {cloth};
  BackwardEulerDescription method;
  method.newton_iterations = 4;
  scene.integrator = method;
  scene.sleep_speed = 0;
  Simulation<float> still(scene);
  still.cloths()[0].particles().place = simulation.cloths()[0].particles().place;
  still.cloths()[0].particles().position = simulation.cloths()[0].particles().position;
  return still;
}

void stop(Particles<float>& particles) {
  for (VectorField<float>* field : {&particles.velocity, &particles.acceleration}) {
    for (Field<float>* component : {&field->x, &field->y, &field->z}) component->fill(0);
  }
}

double relax(Simulation<float>& still) {
  Cloth<float>& cloth = still.cloths()[0];
  double least = cloth.elastic_energy();
  for (int round = 0; round < kMostRounds; ++round) {
    const double before = least;
    for (int step = 0; step < kRound; ++step) {
      stop(cloth.particles());
      still.step();
      least = std::min(least, cloth.elastic_energy());
    }
    if (least > (1 - kLittle) * before) break;
  }
  return least;
}

}  // namespace

double relaxed_energy(const Simulation<float>& simulation) {
  Simulation<float> still = at_rest(simulation);
  return relax(still);
}

void Merges::add(const Simulation<float>& simulation, double before) {
  merges_.push_back({at_rest(simulation), before});
}

double Merges::take_brought_in() {
  double sum = 0;
  for (Merge& merge : merges_) sum += std::max(0.0, relax(merge.relaxing) - merge.before);
  merges_.clear();
  return sum;
}

}  // namespace weft::stability
