#pragma once
/// Which runs there are: every case with every method, level and step rate it claims, and parts of them.
#include <memory>
#include <ostream>

#include "case.h"

namespace weft::stability {

struct HardRun {
  std::shared_ptr<const Case> hard_case;
  Setup setup;
};
/// "S1a_bdf2_L4_60Hz"
std::string name_of(const HardRun& run);
/// For GoogleTest's messages.
inline void PrintTo(const HardRun& run, std::ostream* out) {
  *out << name_of(run) << ": " << run.hard_case->what;
}

/// All there are: explicit methods at 60 Hz, the others at 60, 30 and 15 Hz, at all of the case's levels.
std::vector<HardRun> all_runs();
/// Each case once, but the longest, at its lowest level, methods and rates in turn from case to case.
std::vector<HardRun> sample_runs();
/// Of these every fifth, or all but every fifth.
std::vector<HardRun> every_fifth(std::vector<HardRun> runs);
std::vector<HardRun> all_but_every_fifth(std::vector<HardRun> runs);
/// All methods and rates at each case's lowest level.
std::vector<HardRun> coarsest_runs();

}  // namespace weft::stability
