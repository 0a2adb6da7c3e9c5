#pragma once
/// What goes on around a random scene's cloth beyond balls and steady wind.
#include <optional>
#include <vector>

#include "cloth/world/description.h"
#include "draw.h"

namespace weft::stability {

/// Adds some of: planes, boxes, capsules and meshes that stand or go along paths; gusts and turbulence;
/// strain damping, plate bending, a strain limit, contact of the cloth with itself or tearing,
/// inflation.
void add_surroundings(Draw& draw, SimulationDescription& scene);

/// Adds, in three of ten scenes each: zones where the wind is another one; a second cloth, `other`, near the
/// first. Half of those that an implicit method steps get contact between the two, where they may have it.
void add_company(Draw& draw, const ClothDescription& other, SimulationDescription& scene);

/// A hand that takes hold of the cloth, goes and lets go. Drawn from the scene's seed; null in half of them.
struct Hand {
  Vec2 at{0, 0};      ///< (u, v)
  Vec3 way{0, 0, 0};  ///< m, from kGrabs to kReleases at an even speed
  double force = 0;   ///< N, at most
};
inline constexpr double kGrabs = 0.3, kReleases = 1.2;  ///< s
std::optional<Hand> hand_of(const SimulationDescription& scene);

/// Those of the scene's effects that are on between kSwitchesOff and kSwitchesOn. Drawn from its seed; null
/// in half of them: all stay.
inline constexpr double kSwitchesOff = 0.7, kSwitchesOn = 1.4;  ///< s
std::optional<std::vector<EffectDescription>> kept_effects(const SimulationDescription& scene);

}  // namespace weft::stability
