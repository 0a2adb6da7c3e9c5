#pragma once
/// Cloths and firm solids that strike each other, drawn from a seed: a sheet of cotton, silk, denim or wool,
/// of any size and turn, is thrown at a ball, a box or a capsule that stands, or hangs or floats and has one
/// of them driven through it; at 1 to 30 m/s, 15 to 60 steps a second, levels 3 to 5, by BDF2 or backward
/// Euler, without air or damping. The solid may be far thinner than the way of a step.
#include <cstdint>

#include "cloth/world/simulation.h"

namespace weft::stability {

struct Impact {
  SimulationDescription scene;
  double seconds = 1;  ///< to be run
  double energy = 0;   ///< J, that the blow has: the sheet's mass at the speed of approach, and 1 m of fall
};

/// The same seed gives the same impact on every machine. Nothing touches at the start.
Impact random_impact(std::uint64_t seed);

struct Blow {
  double created = 0;   ///< the most that a step has of energy that nothing gave it, as a share of the blow's
  bool passed = false;  ///< a node passed through the solid (passages.h)
};
Blow strike(const Impact& impact);

}  // namespace weft::stability
