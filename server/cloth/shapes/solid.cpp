#include "cloth/shapes/solid.h"

#include <algorithm>

namespace weft {

Eigen::Matrix3d Solid::turned(double part) const {
  return Eigen::AngleAxisd(part * turn.norm(), turn.normalized()).toRotationMatrix();
}

void Solid::go_on(const Vec3& with, const Vec3& spinning, double fraction, double dt) {
  if (!with.allFinite() || !spinning.allFinite()) return;
  const Vec3 place = at(fraction);
  velocity = with;
  start = place - fraction * dt * velocity;
  position = place + (1 - fraction) * dt * velocity;
  if (spinning == spin) return;
  rotation = placed(fraction).rotation;
  spin = spinning;
  turn = dt * spin;
  rotation = turned(1 - fraction) * rotation;
}

double Solid::gap(const Vec3& node, double from) const { return placed(from).surface(node).distance; }

}  // namespace weft
