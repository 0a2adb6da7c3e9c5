#pragma once
#include <optional>

#include "engines/rows.h"

namespace weft::bench {

/// Something that must be shown.
struct Requirement {
  std::string what, target;
  std::string measured;       ///< empty: what it needs was not in the run
  std::optional<bool> holds;  ///< none: for information
};

/// Three significant digits.
std::string text(double value);
/// A time and, in brackets, its minimum.
std::string time_text(const Measurement& measurement);
/// Ratio of two medians and, in brackets, of the minima.
std::string ratio_text(const Measurement& slow, const Measurement& fast);

// All in scene H with 65 x 65 nodes unless said.

/// Strain and time of bdf2; cost by size and by level.
std::vector<Requirement> own_requirements(const Rows& rows, double damping);
/// Against the baseline, Bullet and NvCloth.
std::vector<Requirement> comparisons(const Rows& rows, double damping);
/// Against the converged motion of the same damped sheet, which this computes.
std::vector<Requirement> energy_requirements(const Rows& rows);
/// Many cloths at once.
std::vector<Requirement> crowd_requirements();
/// The choice of instruction set against the portable build, at 65 x 65 nodes.
std::vector<Requirement> instruction_set_requirements();

}  // namespace weft::bench
