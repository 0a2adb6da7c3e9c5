#pragma once
/// Runs one case with one method, level and step rate, and judges it.
#include "case.h"

namespace weft::stability {

enum class Verdict {
  pass,
  fail,
  limit,      ///< an explicit method beyond the steps it has: expected, recorded
  stretches,  ///< all else holds, but springs are longer than the case allows: XPBD where it does not claim
              ///< it
  pierced,    ///< all else holds, but a solid sticks through a cell and holds it open, where the case says
              ///< that it may
};
const char* name_of(Verdict verdict);

struct Result {
  Verdict verdict = Verdict::pass;
  std::vector<std::string> complaints;  ///< the first of each kind
  double stretch = 0;                   ///< largest from the stated time on
  double stretch_limit = 0;             ///< what the case allows it to be
  double worst_stretch = 0;             ///< largest of all steps
  double energy_rise = 0;               ///< largest energy above the start's, as a share of what is allowed
  double penetration = 0;               ///< m, deepest from the stated time on
  int guard_events = 0;                 ///< how often the step guard stepped in
  double rest_seconds = 0;              ///< until it slept, or was given up, after its last phase
  double milliseconds = 0;              ///< a frame: processor time of this thread, mean
  bool cut_short = false;               ///< ended early, under a sanitizer: what comes later is not judged
};

Result run(const Case& hard_case, const Setup& setup, bool nightly);

}  // namespace weft::stability
