#pragma once
#include "cloth/core/vec3.h"
#include "scene/object.h"
#include "weft/world.h"

/// What callers may give: each function returns the value, or throws weft::Error with its name, the value and
/// the allowed range. The ranges are those of scene files and of the protocol.
namespace weft::library {

inline constexpr scene::Range kPlace{-1e4, 1e4, "m"};
inline constexpr scene::Range kSpeed{-1e3, 1e3, "m/s"};
inline constexpr scene::Range kSpin{-200, 200, "rad/s"};
inline constexpr scene::Range kWindSpeed{0, 100, "m/s"};
inline constexpr scene::Range kAirSpeed{-100, 100, "m/s"};
inline constexpr scene::Range kTurn{-1e6, 1e6};
inline constexpr scene::Range kShare{0, 1};
inline constexpr scene::Range kRadius{0.01, 10, "m"};
inline constexpr scene::Range kMass{1e-3, 1e4, "kg"};
inline constexpr scene::Range kFriction{0, 10};
inline constexpr scene::Range kForce{1e-3, 1e4, "N"};
inline constexpr scene::Range kThreads{1, 1024};
inline constexpr scene::Range kSteps{0, 1e9};

double within(double value, const char* name, const scene::Range& range);
int within(int value, const char* name, const scene::Range& range);
/// Each component.
Vec3 within(const Vector& value, const char* name, const scene::Range& range);
/// Of length 1, from one of any length but 0.
Quaternion unit_turn(const Turn& value, const char* name);

/// "NAME is VALUE; must be one of A, B".
[[noreturn]] void refuse_name(const char* name, std::string_view value,
                              const std::vector<std::string>& known);

inline Vector to_vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace weft::library
