#include "cloth/levels/view_cone.h"

#include <cmath>

namespace weft {

bool ViewCone::touches(const BoundingSphere& sphere) const {
  // In the plane of axis and centre: the cone is all between its axis and a ray.
  const Vec3 way = sphere.centre - eye;
  const double along = way.dot(axis);
  const double aside = (way - along * axis).norm();
  const double cosine = std::cos(half_angle), sine = std::sin(half_angle);
  const double outside = aside * cosine - along * sine;  // of the ray's line; negative within
  if (outside <= 0) return true;
  const double along_ray = along * cosine + aside * sine;
  return (along_ray > 0 ? outside : way.norm()) <= sphere.radius;
}

}  // namespace weft
