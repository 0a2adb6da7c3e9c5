#pragma once
#include <vector>

#include "cloth/shapes/shape.h"

namespace weft {

/// Of two convex shapes that overlap or nearly do: they touch along a normal at these points.
struct Manifold {
  Vec3 normal{0, 1, 0};  ///< unit, from b to a
  struct Point {
    Vec3 place{0, 0, 0};  ///< m
    double gap = 0;       ///< between the two there, along the normal, m; negative: overlap
  };
  std::vector<Point> points;
};

/// Where they touch, if they do so along the unit normal `about`, from b to a, and at `deepest`, or along
/// that of a face along which they overlap less (least_overlap): the face of one, if it has one there, cuts
/// out what of the other's face or edge lies over it, which holds two boxes on each other by their corners;
/// otherwise it is that point, or the middle of the smaller of their edges there. Leaves out what is farther
/// apart than `margin`, m. (Clipping of the incident face by the reference face's sides: D. Gregorius, Robust
/// Contact Creation for Physics Simulations, GDC 2015.)
Manifold manifold_of(const PlacedShape& a, const PlacedShape& b, const Vec3& about, const Vec3& deepest,
                     double margin);

/// The same before they overlap, along the normal of the face that parts them most: only where the face of
/// one has something of the other over it.
Manifold manifold_before(const PlacedShape& a, const PlacedShape& b, double margin);

}  // namespace weft
