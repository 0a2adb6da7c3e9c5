#pragma once
#include <memory>
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

/// Adds strain and speed up over the frames of the last second.
class LastSecond {
 public:
  void add(const SheetState& sheet);
  void report(Measurement& measurement) const;

 private:
  void add_edge(const SheetState& sheet, int a, int b);

  double max_ = 0, sum_ = 0, squared_speed_ = 0;
  double edges_ = 0, nodes_ = 0;  ///< so many summands
};

/// One engine on its way through a scene, each frame timed alone.
class Trial {
 public:
  /// If the 5 s would take more than `budget` seconds of CPU time only the frames of about a second are run:
  /// enough to time them, not to see how the sheet ends.
  Trial(std::unique_ptr<Engine> engine, const EngineScene& scene, double budget);

  /// So many frames more, fewer at the end.
  void run(int frames);
  Measurement measurement() const;

 private:
  void step();

  std::unique_ptr<Engine> engine_;
  EngineScene scene_;
  double budget_;
  SheetState sheet_;
  double start_energy_;
  std::vector<double> times_;  ///< ms
  double spent_ = 0;           ///< ms
  bool finished_ = false;
  LastSecond last_second_;
  Measurement measured_;
};

}  // namespace weft::bench
