#pragma once
#include <utility>
#include <variant>
#include <vector>

#include "cloth/bodies/body_contact.h"
#include "cloth/bodies/body_geometry.h"
#include "cloth/shapes/solid.h"

/// One pair of solids that may meet in a step; for BodyCollision, which tells what is looked at and how.
namespace weft {

/// Of the smaller of two inner radii: what is nearer counts, as an impulse may bring it on; what moves
/// farther may have passed through.
inline constexpr double kBodyMargin = 0.5;

inline bool is_half_space(const Solid& solid) { return std::holds_alternative<HalfSpace>(solid.shape); }
inline bool is_ball(const Solid& solid) { return std::holds_alternative<Sphere>(solid.shape); }
inline bool is_pinned_node(const Solid& solid) { return inner_radius(solid.shape) == 0; }

/// One of the two is where it is for good.
inline bool is_firm(const Solid& a, const Solid& b) {
  const auto fixed = [](const Solid& solid) { return !solid.yields() && !solid.mobile; };
  return fixed(a) || fixed(b);
}

/// Appends where the two touch, or may, in a step of dt, s: all that is found. Only b may be a half-space or
/// a pinned node. `index`: theirs, for the contacts.
void add_contacts(const Solid& a, const Solid& b, std::pair<int, int> index, double dt,
                  BodyGeometry& geometry, std::vector<BodyContact>& contacts);

}  // namespace weft
