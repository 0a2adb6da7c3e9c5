#pragma once
#include <cmath>

#include "cloth/contact/search/features.h"
#include "cloth/core/substep.h"

namespace weft {

/// Part of what layers lack of their gap that they are led apart in a step.
inline constexpr double kLayersLedApart = 0.1;
/// In a substep: in all of a step's it comes to as much, however many there are.
inline double layers_led_apart(const Substep& substep) {
  return 1 - std::pow(1 - kLayersLedApart, substep.to - substep.from);
}

/// Two features of cloth that lie on each other or will in the step.
struct LayerPair {
  FeaturePair features;
  Nearness near;  ///< where they meet, or else as the step is expected to end
  Vec3 normal;    ///< from the second feature to the first
  double gap;     ///< to be kept between them, m
  int side = 0;   ///< of the first node's sheet on which the triangle lies, 0 or 1
  template <class Archive>
  void serialize(Archive& archive) {
    archive(features, near, normal, gap, side);
  }
};

/// How layers press on one another and rub.
struct LayerParameters {
  double gap = 0;      ///< between layers of the cloth, m
  double net_gap = 0;  ///< that the net keeps, m
  double friction = 0;
};

}  // namespace weft
