#pragma once
#include "cloth/world/simulation.h"
#include "scene/object.h"

namespace weft::scene {

/// Pins may only be fixed to colliders that there are; those on what may fly have a stiffness, and all of
/// them on one no more than its step bears (kPinBound). Explicit methods push a body at a step's end by what
/// its pins pull then: at r from its centre it gives way as one of 1 / (1 / mass + r^2 / inertia).
void check_pins(const SimulationDescription& simulation, Report& report);

}  // namespace weft::scene
