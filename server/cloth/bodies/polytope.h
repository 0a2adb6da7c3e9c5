#pragma once
#include <optional>
#include <vector>

#include "cloth/shapes/shape.h"

namespace weft {

/// A convex shape, no half-space, where it is, as its corners and the flat faces between them say.
class Polytope {
 public:
  explicit Polytope(const PlacedShape& shape);

  /// How far it reaches along the unit `direction`, m, as seen from the world's origin.
  double reach(const Vec3& direction) const;
  /// The outline of what of it looks along the unit `direction`, counterclockwise as seen against it: of the
  /// face that does but for `tilt`, the sine of an angle; where it has none, of the corners that are no lower
  /// than the highest by more than this part of its outer radius.
  std::vector<Vec3> facing(const Vec3& direction, double tilt) const;
  /// Its flat faces, in the world; none if it is round all over.
  const std::vector<Face>& faces() const { return faces_; }
  std::size_t corners() const { return corners_.size(); }
  double size() const { return size_; }  ///< outer radius, m
  /// reach(), or some value that is `enough` or more.
  double reach_up_to(const Vec3& direction, double enough) const;

 private:
  /// The same of the corners no lower than by `depth`, m.
  std::vector<Vec3> highest(const Vec3& direction, double depth) const;

  std::vector<Corner> corners_;  ///< in the world
  std::vector<Face> faces_;
  double size_;  ///< outer radius, m
  double flat_;  ///< corners of one face are in a plane but for this, m
};

/// The unit normal, from b to a, along which they overlap least, of `known` and those of their faces (the
/// axes that D. Gregorius, The Separating Axis Test, GDC 2013, looks at, but for the pairs of edges). GJK's
/// normal of shapes that barely touch is at times any direction at all (FCL's issues 495 and 545). `known` if
/// they have too many faces and corners for that.
Vec3 least_overlap(const Polytope& a, const Polytope& b, const Vec3& known);

/// The same of their faces alone, where the shapes are on the two sides of one or nearly so; none if they are
/// of none, or if there are too many.
std::optional<Vec3> parting_face(const Polytope& a, const Polytope& b);

}  // namespace weft
