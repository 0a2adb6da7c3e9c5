#pragma once
/// What a scene's wind is made from: plain values, checked by whoever fills them. Field names equal the names
/// in scene files.
#include <variant>
#include <vector>

#include "cloth/core/vec3.h"

namespace weft {

/// The wind's speed comes and goes, everywhere at once; its direction stays. Reverses it for a moment where a
/// lull is deeper than the speed, which is rare up to an intensity of 0.3.
struct Gusts {
  double intensity = 0.0;   ///< root mean square of the change over the wind's speed; 0: none
  double time_scale = 3.0;  ///< integral time scale, s, > 0: how long a gust lasts (gust_series.h)
};

/// Eddies that the wind carries along, as they turn over: the air's velocity differs from place to place.
struct Turbulence {
  double intensity = 0.0;     ///< root mean square of each component over the wind's speed; 0: none
  double length_scale = 0.5;  ///< longitudinal integral length scale, m, > 0: the eddies' size (eddies.h)
};

/// A box around `position`.
struct BoxZone {
  Vec3 size{1.0, 1.0, 1.0};                         ///< lengths of its edges, m; > 0
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  static constexpr const char* kName = "box";
};
/// A ball around `position`.
struct SphereZone {
  double radius = 1.0;  ///< m, > 0
  static constexpr const char* kName = "sphere";
};

/// Where the air moves otherwise: before a fan, in the lee of a wall. In the shape `velocity` is instead of
/// the wind and its gusts; over s = 0 to 1 edges outside of it that fades by 1 - 3 s^2 + 2 s^3. Turbulence
/// stays. Later zones lie over earlier ones. Our own: flow primitives that add up (Wejchert and Haumann,
/// Animation Aerodynamics, 1991) have no lee.
struct WindZone {
  std::variant<BoxZone, SphereZone> shape;
  Vec3 position{0.0, 0.0, 0.0};  ///< of the centre, m
  Vec3 velocity{0.0, 0.0, 0.0};  ///< m/s
  double edge = 0.1;             ///< m, > 0
};

/// The scene's wind, read by paper_wind and aerodynamics.
struct Wind {
  Vec3 direction{0.0, 0.0, -1.0};  ///< unit
  double speed = 0.0;              ///< mean, m/s, >= 0
  Gusts gusts = {};
  Turbulence turbulence = {};
  std::vector<WindZone> zones = {};
  Vec3 velocity() const { return speed * direction; }  ///< mean, outside of zones
};

}  // namespace weft
