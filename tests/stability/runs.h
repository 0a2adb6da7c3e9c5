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
/// Level 4, or the case's own lowest.
std::vector<HardRun> coarsest_runs();
/// Of level 5, where that is not the lowest, the default integrator and XPBD at 60 Hz, but for the cases in
/// which they take long.
std::vector<HardRun> finer_runs();
/// The same two of level 6, twice as much work as all before: with the nightly mode, but in CI's lengths.
std::vector<HardRun> finest_runs();

}  // namespace weft::stability
