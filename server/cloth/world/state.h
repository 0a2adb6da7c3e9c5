#pragma once
#include <string>
#include <string_view>

#include "cloth/world/simulation.h"

namespace weft {

/// All that the next steps of a simulation follow from, its description apart: effects, integrators,
/// materials and wind as they are now, every node, ball and body, what integrators, contact and step guard
/// remember, and what sleeps. In the memory's own byte order; of use to the same build of Weft alone.
template <class Real>
std::string save_state(const Simulation<Real>& simulation);

/// Goes on from there, to the bit, on any number of threads: `simulation` is of the same description,
/// whatever has happened in it. Effects by Cloth::add_effect stay where they were added. Bytes that
/// save_state() did not make are not all told from those that it did: keep a checksum beside them.
///
/// Throws BadState (core/archive.h) if they end too early or go on too long, and std::invalid_argument if
/// they are of another description; the simulation is then of no use until its reset().
template <class Real>
void load_state(Simulation<Real>& simulation, std::string_view state);

extern template std::string save_state(const Simulation<float>&);
extern template std::string save_state(const Simulation<double>&);
extern template void load_state(Simulation<float>&, std::string_view);
extern template void load_state(Simulation<double>&, std::string_view);

}  // namespace weft
