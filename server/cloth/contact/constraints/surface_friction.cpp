#include "cloth/contact/constraints/surface_friction.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft {

void SurfaceFriction::go_on_from(const SurfaceFriction& last) {
  lasts_ = true;
  gained_ = last.gained_;
}

void SurfaceFriction::keep_force_of(const SurfaceFriction& last, const Vec3& normal) {
  grip_ = across(last.grip_, normal);
}

double SurfaceFriction::expected_stretch() const {
  return std::max(0.0, stretch(going_on_).norm() + gained_.lasting());
}

void SurfaceFriction::hold_at(double stretch, double holds) {
  rate_ = holds <= 0 ? 0 : stretch * stiffness_ <= holds ? stiffness_ : holds / stretch;
}

void SurfaceFriction::linearise(const Vec3& slip, double holds, double stiffness, double inertia) {
  inertia_ = inertia;
  if (!std::exchange(solved_, true)) {
    stiffness_ = stiffness;
    if (lasts_) {
      hold_at(expected_stretch(), holds);
    } else {
      hold_at(std::max(0.0, going_on_.norm() - stopped_), inertia * stopped_);
    }
    return;
  }
  double stretched = stretch(slip).norm();
  const double pull = rate_ * stretched;
  if (rate_ == stiffness_ && pull > holds) stretched += (pull - holds) / inertia;
  stiffness_ = stiffness;
  hold_at(stretched, holds);
}

double SurfaceFriction::error(const Vec3& slip, double holds) const {
  const double stretched = stretch(slip).norm(), pull = rate_ * stretched;
  // Let go, the node alone would go farther than the spring lets it.
  if (rate_ == stiffness_ && pull > holds) return (pull - holds) * (pull - holds) / (2 * inertia_);
  return std::abs(pull - std::min(stiffness_ * stretched, holds)) * slip.norm() / 2;
}

void SurfaceFriction::end(const Vec3& slip, double holds) {
  if (!solved_) return;
  hold_at(stretch(slip).norm(), holds);
  grip_ = force(slip);
  gained_.add(slip.norm() - going_on_.norm());
}

}  // namespace weft
