#pragma once
/// Scenes drawn from a seed: a cloth of any size, aspect, fabric, hold and turn, balls, wind, integrator,
/// step; in half of them more around it, in some wind zones and a second cloth (random_surroundings.h).
#include "case.h"

namespace weft::stability {

/// The same seed gives the same scene, on every machine. Every value is one that a scene file may have. The
/// cloth's levels go up to `max_level`; symplectic Euler is drawn only where it takes no more than some
/// hundreds of substeps.
SimulationDescription random_scene(std::uint64_t seed, int max_level);

struct Failure {
  enum class Kind { not_finite, guard, inside, energy };
  Kind kind = Kind::not_finite;
  std::string what;  ///< with figures, for the reader
};
/// What is wrong with a scene, if anything is.
using Check = std::function<std::optional<Failure>(const SimulationDescription&)>;

/// Runs a scene for 2 s: something is not finite, the step guard had to take a step back, a node that is not
/// pinned ends a step inside a solid that does not yield, and not between two, or there is more energy than
/// gravity, wind, bodies, pressure, a hand and changes of level by the paper's rules can have brought in. A
/// cloth of several levels goes up and down through them, a level every 1 + seed % 16 steps; by its seed a
/// hand pulls it, effects are switched off and on again. A sheet under more pressure than its springs can
/// balance may burst, beyond any bound, and has the guard hold it: from then on it is only to be finite.
std::optional<Failure> check(const SimulationDescription& scene);

/// The smallest scene found with the same kind of failure, by taking things away from one that has it: balls,
/// effects, pins, the turn, and so on down to the ordinary sheet at level 3.
SimulationDescription shrink(SimulationDescription scene, const Check& check);

}  // namespace weft::stability
