#pragma once
#include <string>

#include "engines/engine.h"
#include "engines/engine_scene.h"

namespace weft::bench {

inline constexpr int kFrames = 300;  ///< 5 s
inline constexpr int kFramesPerSecond = 60;

struct Measurement {
  double median_ms = 0, least_ms = 0;  ///< CPU time a frame
  int frames = 0;                      ///< simulated; fewer than kFrames if time was short or the sheet burst
  // Over the last second:
  double max_strain = 0;       ///< |length - rest| / rest of structural edges, any edge in any frame
  double mean_strain = 0;      ///< of all edges in all frames
  double rms_speed = 0;        ///< m/s
  std::vector<double> energy;  ///< after each frame, J: kinetic and height energy, 0 at the start
  bool exploded = false;       ///< NaN, or a box around the sheet of more than 8 m
  bool lost = false;           ///< it has left the ball (scene B)

  bool complete() const { return frames == kFrames && !exploded; }
  bool broken() const { return complete() && max_strain > 10; }
  bool sound() const { return complete() && !broken() && !lost; }
  std::string state() const;
};

/// Steps the engine, made for that scene, for 5 s, timing each frame alone. If that would take more than
/// `budget` seconds of CPU time only the frames of about a second are run: enough to time them, not to see
/// how the sheet ends.
Measurement measure(Engine& engine, const EngineScene& scene, double budget);

}  // namespace weft::bench
