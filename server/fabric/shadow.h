#pragma once
#include <vector>

#include "cloth/core/vec3.h"

namespace weft::fabric {

/// The shadow of triangles on the ground, y = 0, in vertical light, in pixels.
class Shadow {
 public:
  /// Of x and z from -side/2 to 3/2 side: twice as wide as a specimen that begins at the origin.
  Shadow(double side, double pixel);
  /// The pixels whose centres the triangle covers, whichever way it turns.
  void add(const Vec3& a, const Vec3& b, const Vec3& c);
  double area() const;  ///< m2; what lies over itself counts once

 private:
  double origin_, pixel_;
  int pixels_;
  std::vector<char> dark_;
};

}  // namespace weft::fabric
