#include "cloth/contact/solid.h"

#include <algorithm>

namespace weft {

Eigen::Matrix3d Solid::turned(double part) const {
  return Eigen::AngleAxisd(part * turn.norm(), turn.normalized()).toRotationMatrix();
}

double Solid::depth(const Vec3& node, double from) const {
  return std::max(0.0, -placed(from).surface(node).distance);
}

}  // namespace weft
