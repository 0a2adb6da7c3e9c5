#pragma once
#include "cloth/air/air.h"
#include "cloth/core/particles.h"

namespace weft {

/// The air's velocity at a cloth's nodes, where it differs from place to place: once a step, for its middle.
/// Single precision: air is not known better.
class NodeAir {
 public:
  /// Eddies are evaluated at nodes at most this share of their length scale apart, and bilinearly in between:
  /// off by 3 % of their root mean square (a test measures it).
  static constexpr double kSpacing = 0.25;

  /// The air at `time`, s, where the nodes' velocities take them in `ahead` seconds. `spacing` are the
  /// distances of neighbours along a row and a column, m. Valid until the next call.
  template <class Real>
  const VectorField<float>& sample(const Air& air, const Particles<Real>& particles, const Vec2& spacing,
                                   double time, double ahead);

 private:
  Eigen::AlignedBox3f box_around_points();
  /// Of those that come near the nodes: the others would change no bit.
  void add_zones(const Air& air);
  /// Of turbulent air alone.
  void add_eddies(const Air& air, const Vec2& spacing, double time);

  Vec3 place_{0, 0, 0};                   ///< that the points are seen from, m
  VectorField<float> points_, velocity_;  ///< at all nodes
  VectorField<float> few_points_,
      few_velocity_;  ///< where eddies are evaluated, if not at all nodes; one row. Empty in calm air
  std::vector<float> low_, high_;  ///< of the points' columns; empty without zones
};

}  // namespace weft
