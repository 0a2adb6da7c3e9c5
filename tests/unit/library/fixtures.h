#pragma once
#include <gtest/gtest.h>

#include <string>

#include "weft/world.h"

namespace weft {

/// A sheet of 1 m x 1 m that falls beside a ball at rest and a box with a mass.
inline const char* const kFalling = R"({
  "cloths": [{"name": "sheet", "size": [1, 1], "levels": {"min": 3, "max": 5},
              "material": {"density": 0.2, "structural": 500, "shear": 50, "bending": 0.01, "damping": 0.1}}],
  "effects": [{"type": "gravity"}, {"type": "damping"}],
  "level_policy": {"thresholds": [1, 10], "levels": [5, 4, 3], "hysteresis": 0},
  "colliders": [{"type": "ball", "position": [5, 0, 0], "radius": 0.2},
                {"type": "box", "position": [-5, 0, 0], "size": [1, 1, 1], "mass": 2, "motion": "kinematic"},
                {"type": "plane", "position": [0, -100, 0], "normal": [0, 1, 0]}]
})";

/// What the call throws says.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing is wrong";
}

}  // namespace weft
