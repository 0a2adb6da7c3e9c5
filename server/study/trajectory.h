#pragma once
/// One run of a scene, kept frame by frame so that two runs can be compared.
#include <functional>
#include <vector>

#include "cloth/world/description.h"

namespace weft {
template <class Real>
class Simulation;
}

namespace weft::study {

/// The nodes kept of one cloth: all of them up to this level, every 2^k-th of a finer grid. Bounds memory.
inline constexpr int kKeptLevel = 6;
/// Frames a run may have at most. Bounds memory: 200 MB for one cloth at kKeptLevel.
inline constexpr int kMaxFrames = 2000;

struct Sheet {
  int rows = 0, cols = 0;  ///< of the nodes kept
  double size = 1;         ///< the cloth's longer side, m
};

/// The state after one step; frame 0 is the start.
struct Frame {
  std::vector<double> positions;  ///< x, y, z interleaved, cloth by cloth, row by row, m
  double kinetic_energy = 0;      ///< J, all cloths
  double potential_energy = 0;    ///< J, springs and gravity
  double mean_strain = 0;         ///< of structural springs; mean of the cloths
  double max_strain = 0;          ///< largest stretch
  double max_compression = 0;
  Vec3 centre{0, 0, 0};  ///< of the first cloth, m
};

struct Trajectory {
  double time_step = 0;  ///< s, between frames
  std::vector<Sheet> sheets;
  std::vector<Frame> frames;
  std::vector<double> step_seconds;  ///< this thread's processor time of each step alone, which other
                                     ///< programs hardly disturb; nothing is kept or compared meanwhile
  int substeps = 0;                  ///< of the last step; the most of all cloths
  bool sound = true;  ///< false if the start is not finite or the step guard had to step in, either of which
                      ///< ends the run
  bool complete = false;  ///< all frames asked for are here

  /// Median of step_seconds, ms; 0 without steps.
  double milliseconds_per_frame() const;
};

struct RunPlan {
  int level = 5;           ///< every cloth's, whatever its own limits
  int frames = 120;        ///< steps
  int kept_every = 1;      ///< steps from one kept frame to the next; divides `frames`
  double disturbance = 0;  ///< random offset of every free node at the start, up to this share of its cloth's
                           ///< size: what rounding does to a start
};

/// The scene's own start, split or merged to `level` as `weft run --level` does, whatever the cloths' own
/// limits. Its cloths never sleep: every step is made.
template <class Real>
Simulation<Real> at_level(SimulationDescription description, int level);

/// Called after each frame with the frames done; false ends the run early.
using Watch = std::function<bool(int)>;

/// From at_level on.
template <class Real>
Trajectory simulate(SimulationDescription description, const RunPlan& plan, const Watch& watch);

extern template Simulation<float> at_level(SimulationDescription, int);
extern template Simulation<double> at_level(SimulationDescription, int);
extern template Trajectory simulate<float>(SimulationDescription, const RunPlan&, const Watch&);
extern template Trajectory simulate<double>(SimulationDescription, const RunPlan&, const Watch&);

}  // namespace weft::study
