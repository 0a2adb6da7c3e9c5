#pragma once
/// The answer that a study measures against, computed until it stands still.
#include <functional>
#include <vector>

#include "study/errors.h"

namespace weft::study {

/// A share of a study's time. The clock is the caller's, so that tests need no real one.
struct Allowance {
  std::function<double()> now;  ///< s, never descending
  double end = 0;               ///< of the same clock
  double left() const { return end - now(); }
};

/// One step size tried on the way to the reference.
struct Rung {
  int substeps = 0;
  double seconds = 0;   ///< that it took
  double doubling = 0;  ///< how far this run is from the rung's before it: rms_position; 0 for the first
  Errors change;        ///< how far the answer moved with it; zero for the first
};

/// The scene at one level in double precision by BDF2, every system solved tightly, substeps doubled until
/// doubling no longer matters. The answer of two runs is extrapolated from both (Richardson): an error that
/// falls with the square of the step is a third of their difference.
struct Reference {
  int level = 0;
  Trajectory answer;
  std::vector<Rung> rungs;  ///< as far as the allowance went; at least two unless runs went bad
  Errors rounding;          ///< how far starts that differ by single precision's rounding part
  /// Starts that differ by rounding part by more than kChaos: positions then mean nothing, statistics do; and
  /// nothing is extrapolated.
  bool chaotic = false;

  bool usable() const { return rungs.size() >= 2; }
  /// By how much the last doubling moved the answer: a measure of the error that is left.
  const Errors& change() const { return rungs.back().change; }
  /// How many times closer together the last two runs are than the two before; 4 for second order, 0 when
  /// there are not enough.
  double reduction() const;
};

inline constexpr double kChaos = 1e-4;           ///< rms, in cloth sizes
inline constexpr double kSingleRounding = 6e-8;  ///< half a unit in the last place of 1.0f

/// Doubles the substeps from 2 on until the answer moves by less than `target` (rms, in cloth sizes;
/// statistics if chaotic) or the next doubling would not fit into `allowance`. Two rungs are run in any case.
/// `watch` is called after every frame.
Reference find_reference(const SimulationDescription& description, int level, int frames, double target,
                         const Allowance& allowance, const std::function<void()>& watch);

}  // namespace weft::study
