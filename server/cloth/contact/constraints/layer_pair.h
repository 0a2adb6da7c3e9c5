#pragma once
#include <algorithm>
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

/// How a pair's nodes share what moves it: their inverse masses, 1/kg, or what stands for them.
struct PairShare {
  double sum = 0;      ///< each by the square of its weight: what an impulse moves the pair by
  double largest = 0;  ///< by its weight: what it moves a node by, at most
  void add(double weight, double inverse_mass) {
    sum += weight * weight * inverse_mass;
    largest = std::max(largest, std::abs(weight) * inverse_mass);
  }
  /// By which an impulse is divided so that no node goes farther than the pair is to. Of equal masses none
  /// would; but where only a node of a small weight can move, beside pinned ones, it would go by the inverse
  /// of that, and pull the others after it.
  double bounded() const { return std::max(sum, largest); }
  /// How far the pair then goes of what it is to.
  double part() const { return largest > 0 ? sum / bounded() : 1; }
};

/// How layers press on one another and rub.
struct LayerParameters {
  double net_gap = 0;  ///< that the net keeps, m
  double friction = 0;
};

}  // namespace weft
