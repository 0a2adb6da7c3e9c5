#pragma once
#include <cstdint>

#include "cloth/world/simulation.h"

namespace weft {

/// 64 bits of the whole state: step count, and each cloth's level and nodes, each ball's place and motion,
/// bit by bit (FNV-1a: Fowler, Noll, Vo). Equal states have equal hashes; states that differ in one bit
/// hardly ever do.
template <class Real>
std::uint64_t state_hash(const Simulation<Real>& simulation);

extern template std::uint64_t state_hash(const Simulation<float>&);
extern template std::uint64_t state_hash(const Simulation<double>&);

}  // namespace weft
