#include "host/picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/grid_codec.h"

namespace weft::host {
namespace {

constexpr double kWidestHalfAngle = 1.2;  // rad: a flat picture of more would be all edge
/// A node is rounded by half a quantum along each axis at most, and all of that may be across the line of
/// sight.
constexpr double kFarthest = std::numbers::sqrt3 / 2;

}  // namespace

double pixel_angle(double half_angle) {
  return std::tan(std::min(half_angle, kWidestHalfAngle)) / (kPicturePixels / 2);
}

int exponent_for_picture(const ViewCone& view, const Eigen::AlignedBox3d& box, double cell) {
  const double distance = box.exteriorDistance(view.eye);
  const double seen = kPixelShare * pixel_angle(view.half_angle) * distance / kFarthest;
  const int coarsest = std::ilogb(cell / kCellQuanta);
  if (seen < std::ldexp(1.0, coarsest - kLattices + 1)) return protocol::kMinQuantumExponent;
  return std::clamp(std::ilogb(seen), protocol::kMinQuantumExponent,
                    std::max(coarsest, protocol::kMinQuantumExponent));
}

}  // namespace weft::host
