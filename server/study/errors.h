#pragma once
/// How far one run is from another.
#include <optional>

#include "study/trajectory.h"

namespace weft::study {

struct Errors {
  double rms_position = 0;  ///< over all shared nodes and all frames but the start, in cloth sizes
  double max_position = 0;  ///< the largest of the same, in cloth sizes
  double mean_shape = 0;    ///< root mean square over nodes, of positions averaged over the frames: holds its
                            ///< meaning where motion is chaotic; in cloth sizes
  double strain = 0;        ///< root mean square over frames of the mean strain's difference
  std::optional<double>
      energy;  ///< root mean square over frames of the total energy's difference, as a share
               ///< of energy_exchanged of the reference; absent where nothing is exchanged
  std::optional<double>
      frequency;  ///< relative error of `frequency`; absent where the reference does not swing
};

/// `run` against `reference`: equally many frames of the same cloths, at any two levels. Levels are nested:
/// only nodes that both have are compared. Throws std::invalid_argument otherwise.
Errors errors_of(const Trajectory& run, const Trajectory& reference);

/// What passes between motion and rest: the larger range (highest less lowest over the frames) of the kinetic
/// and the potential energy, J.
double energy_exchanged(const Trajectory& run);

/// Hz: how fast the first cloth's centre swings through its mean along the axis that it moves along most.
/// From the first to the last crossing; absent with fewer than three crossings, or when they are too unevenly
/// spaced to be one oscillation.
std::optional<double> frequency(const Trajectory& run);

}  // namespace weft::study
