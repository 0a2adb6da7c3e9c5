#pragma once
#include "cloth/core/vec3.h"

namespace weft {

/// What a contact gives its a, N s; b gets the opposite.
struct BodyImpulse {
  double along = 0;       ///< along the normal
  Vec3 rubbing{0, 0, 0};  ///< across it
};

/// Where two solids touch, or may in the step.
struct BodyContact {
  int a = 0, b = 0;      ///< the solids, indices
  Vec3 arm_a{0, 0, 0};   ///< of the place from a's centre, in the middle of the step, m
  Vec3 arm_b{0, 0, 0};   ///< the same from b's
  Vec3 normal{0, 1, 0};  ///< unit, from b to a
  double gap = 0;        ///< along the normal when the step begins, m; negative: they overlap by it
  double friction = 0;   ///< Coulomb's coefficient of the two
  bool firm = false;     ///< one of them never moves: this is kept where not all can be
  double borne = 0;      ///< what has pushed them apart in the step before: friction has it, too, N s
  BodyImpulse start{};   ///< resolve() starts from it
};

}  // namespace weft
