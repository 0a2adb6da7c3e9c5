#pragma once
#include <cstdint>

#include "cloth/contact/shape.h"

namespace weft {

/// Of a ball (1, 2, ...) or an obstacle (kFirstObstacle, ...).
using ColliderId = std::uint32_t;
inline constexpr ColliderId kFirstObstacle = 0x8000'0000;

/// What the cloths meet in a step: a shape on a straight way.
struct Solid {
  ColliderId id = 0;
  Shape shape;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double friction = 0;  ///< Coulomb's coefficient
  bool yields = false;  ///< takes up what the cloths give it
  /// Steps, this one counted, within which nodes that it was put onto are led out: pushed out at once they
  /// would fly off. 0: at once, as nothing can have come inside but by rounding.
  int steps_to_clear = 0;
  Vec3 start{0, 0, 0};     ///< centre at the step's start, m
  Vec3 position{0, 0, 0};  ///< at its end, m
  Vec3 velocity{0, 0, 0};  ///< mean over the step, m/s

  /// Centre at `fraction` (0..1) of the step.
  Vec3 at(double fraction) const { return start + fraction * (position - start); }
  PlacedShape placed(double fraction) const { return {shape, at(fraction), rotation}; }
  /// How far a node that is at `node`, inside, when a part of the step begins is led out in it, m; 0 outside.
  double led_out(const Vec3& node, double from, double to) const;
  /// How deep, m, it then still is.
  double depth_left(const Vec3& node, double from, double to) const;
};

}  // namespace weft
