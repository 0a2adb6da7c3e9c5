#include <cmath>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/wind_kernels.h"

// Apart from wind_kernels.cpp: a wind without zones is linked without this.
namespace weft::kernels {
namespace {

/// Of a point from the zone.
[[gnu::always_inline]] inline float distance_to(const AirZone& zone, float x, float y, float z) {
  x -= zone.centre[0];
  y -= zone.centre[1];
  z -= zone.centre[2];
  float squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float* own = zone.axes[axis];
    const float beyond = std::abs(own[0] * x + own[1] * y + own[2] * z) - zone.half[axis];
    const float outside = beyond > 0.0F ? beyond : 0.0F;
    squared += outside * outside;
  }
  const float beyond = std::sqrt(squared) - zone.radius;
  return beyond > 0.0F ? beyond : 0.0F;
}

}  // namespace

WEFT_MULTIVERSION void blend_zone(const AirZone& zone, Components<const float> points, std::size_t count,
                                  Components<float> velocity) {
  const AirZone own = zone;  // which the loop does not write to
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const float edges = distance_to(own, points.x[i], points.y[i], points.z[i]) * own.one_over_edge;
    const float s = edges < 1.0F ? edges : 1.0F;
    const float weight = 1.0F - s * s * (3.0F - 2.0F * s);
    velocity.x[i] += weight * (own.velocity[0] - velocity.x[i]);
    velocity.y[i] += weight * (own.velocity[1] - velocity.y[i]);
    velocity.z[i] += weight * (own.velocity[2] - velocity.z[i]);
  }
}

}  // namespace weft::kernels
