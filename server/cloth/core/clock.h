#pragma once
/// How long a part of a step takes: steps report it, nothing in them depends on it.
#include <chrono>

namespace weft {

using Clock = std::chrono::steady_clock;

inline double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace weft
