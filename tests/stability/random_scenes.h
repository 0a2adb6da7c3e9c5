#pragma once
/// Scenes drawn from a seed: a cloth of any size, aspect, fabric, hold and turn, balls, wind, integrator,
/// step; in half of them more around it (random_surroundings.h).
#include "case.h"

namespace weft::stability {

/// The same seed gives the same scene, on every machine. Every value is one that a scene file may have. The
/// cloth's levels go up to `max_level`; symplectic Euler is drawn only where it takes no more than some
/// hundreds of substeps.
SimulationDescription random_scene(std::uint64_t seed, int max_level);

/// Runs a scene for 2 s and says what is wrong with it: something is not finite, or there is more energy than
/// gravity, wind, bodies, pressure and a hand can have brought in. A cloth of several levels goes up and down
/// through them, a level every 1 + seed % 16 steps; by its seed a hand pulls it, effects are switched off and
/// on again.
Complaint check(const SimulationDescription& scene);

/// The smallest scene found that `fails`, by taking things away from one that does: balls, effects, pins, the
/// turn, and so on down to the ordinary sheet at level 3.
SimulationDescription shrink(SimulationDescription scene,
                             const std::function<bool(const SimulationDescription&)>& fails);

}  // namespace weft::stability
