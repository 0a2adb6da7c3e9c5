#pragma once
#include "cloth/world/simulation.h"

namespace weft::stability {

/// That a random scene runs.
inline constexpr double kRandomSeconds = 2;

/// Upper bound of what wind, bodies, pressure and the hand can do on the cloths in that time, J. Generous: it
/// parts what is bounded from what runs away.
double input(const SimulationDescription& scene);

/// No springs bear what the scene does to some cloth: where it gets to is for the guard to say.
bool overloaded(const SimulationDescription& scene);

/// The least that a state of the first cloth has which the guard takes back, J: of one node, or one spring.
double energy_beyond_guard(const SimulationDescription& scene);

}  // namespace weft::stability
