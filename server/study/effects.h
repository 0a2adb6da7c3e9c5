#pragma once
/// What each effect of a scene costs.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cloth/world/description.h"

namespace weft::study {

struct EffectCost {
  std::string_view name;
  double milliseconds = 0;  ///< a frame: what the scene takes more with it than without it
};

/// A frame's processor time at one level, ms, and where it goes.
struct EffectsStudy {
  int level = 0;
  double all = 0;                   ///< the scene as it is
  std::vector<EffectCost> effects;  ///< in the scene's order
  /// Gusts, turbulence and zones of the wind, friction: those that the scene has. They cost what they add to
  /// the effects that feel the wind, and to contact.
  std::vector<EffectCost> parts;
  double contact = 0;  ///< what the scene takes more with its colliders than without them
  double rest = 0;     ///< the scene without effects and colliders: springs, integrator, check
};

/// Steps the scene, the scene without each effect or part, that without colliders and that without all, in
/// single precision and in turns: each frame begins from the full scene's whole state
/// (Simulation::take_state) and is taken by all of them, in changing order, so that noise and the processor's
/// moods meet all alike. Each figure is the mean of the middle half of the frames' differences.
///
/// An effect's figure is so what it costs in a step, not what a scene would cost that had never had it. What
/// it has done to the cloth is in both: without tearing a torn sheet stays as torn as it is. What is there
/// only as long as the effect is goes with it: without inflation a bag is open, as full as it is.
EffectsStudy study_effects(const SimulationDescription& description, int level, int frames,
                           const std::function<void()>& watch);

/// Plain text.
std::string table(const EffectsStudy& study);

}  // namespace weft::study
