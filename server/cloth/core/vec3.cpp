#include "cloth/core/vec3.h"

#include <cmath>

namespace weft {
namespace {

/// So near to -y the axis cannot be told from rounding (as Eigen has it).
constexpr double kOpposite = 1e-12;

}  // namespace

Quaternion turn_from_y(const Vec3& direction) {
  const Vec3 to = direction.normalized();
  if (to.y() < -1 + kOpposite) return {0, 0, 0, 1};
  // Of half the angle: the cosine, and the axis times the sine (y cross `to`, by twice the cosine).
  const double twice_cosine = std::sqrt((1 + to.y()) * 2);
  return {twice_cosine * 0.5, to.z() / twice_cosine, 0, -to.x() / twice_cosine};
}

}  // namespace weft
