#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"
#include "study/study.h"

namespace weft::study::test {

/// A sheet of 2 x 2 nodes, side 2 m, lying still, energies and strain 0, with as many frames besides the
/// start.
inline Trajectory still(int frames, double time_step = 0.5) {
  Trajectory run;
  run.time_step = time_step;
  run.sheets = {{2, 2, 2.0}};
  run.frames.assign(static_cast<std::size_t>(frames) + 1, Frame{});
  for (Frame& frame : run.frames) frame.positions = {0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0};
  run.complete = true;
  return run;
}

/// The preset made for studies: it swings without folding.
inline SimulationDescription swing() { return std::get<scene::Scene>(scene::load("swing")).simulation; }

inline const auto kNothing = [] {};

}  // namespace weft::study::test
