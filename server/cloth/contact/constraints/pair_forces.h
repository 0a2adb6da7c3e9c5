#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cloth/contact/constraints/slip_gain.h"
#include "cloth/core/vec3.h"

namespace weft {

/// By what a pair of features is known again in the next step: node and side, or both edges.
using PairKey = std::array<std::uint32_t, 4>;

/// How a pair presses along its normal, and what static friction holds it with.
struct PairForce {
  PairKey pair;
  double force = 0;    ///< N
  Vec3 grip{0, 0, 0};  ///< on the first feature, N
  SlipGain gained{};
  bool between_cloths = false;  ///< which are stepped side by side, so that each finds one of its own
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pair, force, grip, gained, between_cloths);
  }
};

/// Makes the forces that two cloths have found for one pair their mean, so that each gives what the other
/// takes. `of_cloths` are each cloth's forces; between cloths every pair is there once at most. What only one
/// found to press keeps its force.
void share_forces(std::span<std::vector<PairForce>* const> of_cloths);

}  // namespace weft
