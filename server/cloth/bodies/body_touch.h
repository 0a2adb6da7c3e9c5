#pragma once
#include <vector>

#include "cloth/bodies/body_contact.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A BodyContact as its solids go on: the place on each moves with it.
class BodyTouch {
 public:
  /// Of these solids as they move in a step that has begun.
  BodyTouch(const BodyContact& contact, const std::vector<Solid>& solids);

  std::size_t a() const { return a_; }  ///< index of the solid
  std::size_t b() const { return b_; }
  /// Unit, from b to a.
  const Vec3& normal() const { return normal_; }
  /// At `fraction` of the step, by how much more they overlap than when it began, or, if they were apart,
  /// than not at all, m; below 0 they are so far from it.
  double overlap(const std::vector<Solid>& solids, double fraction) const;
  /// Of the place from a's centre, or b's, then, m; 0 of what does not turn.
  Vec3 arm_a(const std::vector<Solid>& solids, double fraction) const;
  Vec3 arm_b(const std::vector<Solid>& solids, double fraction) const;

  /// What the cloth's step has pushed the two apart by, N s.
  double impulse = 0;

 private:
  std::size_t a_, b_;
  Vec3 on_a_, on_b_;  ///< the place, along their own axes, m
  Vec3 normal_;
  double least_;  ///< of the one place's way along the normal as seen from the other: here they just touch, m
};

}  // namespace weft
