#include "cloth/contact/solid.h"

#include <algorithm>

namespace weft {
namespace {

double depth(const PlacedShape& shape, const Vec3& point) {
  return std::max(0.0, -shape.surface(point).distance);
}

}  // namespace

Eigen::Matrix3d Solid::turned(double part) const {
  return Eigen::AngleAxisd(part * turn.norm(), turn.normalized()).toRotationMatrix();
}

double Solid::led_out(const Vec3& node, double from, double to) const {
  const double share = steps_to_clear > 0 ? (to - from) / (steps_to_clear - from) : 1.0;
  return share * depth(placed(from), node);
}

double Solid::depth_left(const Vec3& node, double from, double to) const {
  return steps_to_clear > 0 ? depth(placed(from), node) - led_out(node, from, to) : 0.0;
}

}  // namespace weft
