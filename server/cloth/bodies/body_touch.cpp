#include "cloth/bodies/body_touch.h"

#include <algorithm>

namespace weft {
namespace {

/// Where the place is that is so along the solid's own axes.
Vec3 place_of(const Solid& solid, const Vec3& own, double fraction) {
  const PlacedShape placed = solid.placed(fraction);
  return placed.centre + placed.rotation * own;
}

Vec3 own_axes(const Solid& solid, const Vec3& arm, double fraction) {
  return solid.placed(fraction).rotation.transpose() * arm;
}

Vec3 arm_of(const Solid& solid, const Vec3& own, double fraction) {
  if (!solid.yields_turning()) return {0, 0, 0};
  return solid.placed(fraction).rotation * own;
}

}  // namespace

BodyTouch::BodyTouch(const BodyContact& contact, const std::vector<Solid>& solids)
    : a_(static_cast<std::size_t>(contact.a)),
      b_(static_cast<std::size_t>(contact.b)),
      on_a_(own_axes(solids[a_], contact.arm_a, 0.5)),
      on_b_(own_axes(solids[b_], contact.arm_b, 0.5)),
      normal_(contact.normal),
      least_(normal_.dot(place_of(solids[a_], on_a_, 0) - place_of(solids[b_], on_b_, 0)) -
             std::max(0.0, contact.gap)) {}

double BodyTouch::overlap(const std::vector<Solid>& solids, double fraction) const {
  return least_ - normal_.dot(place_of(solids[a_], on_a_, fraction) - place_of(solids[b_], on_b_, fraction));
}

Vec3 BodyTouch::arm_a(const std::vector<Solid>& solids, double fraction) const {
  return arm_of(solids[a_], on_a_, fraction);
}

Vec3 BodyTouch::arm_b(const std::vector<Solid>& solids, double fraction) const {
  return arm_of(solids[b_], on_b_, fraction);
}

}  // namespace weft
