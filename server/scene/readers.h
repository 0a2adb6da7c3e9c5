#pragma once
/// The parts of a scene file, one function each. Every problem goes to `report` with its pointer; what is
/// returned is only meaningful if there were none.
#include <filesystem>
#include <optional>

#include "scene/motion/motion_files.h"
#include "scene/object.h"

namespace weft::scene {

// Limits of a scene (D10); scene.schema.json states the same.
inline constexpr std::size_t kMaxCloths = 16;
inline constexpr std::size_t kMaxColliders = 64;
inline constexpr int kMaxClothNodes = 257 * 257;  ///< at the cloth's highest level
inline constexpr std::size_t kMaxPins = 256;
inline constexpr std::size_t kMaxWaypoints = 10000;
inline constexpr std::size_t kMaxWindZones = 16;
inline constexpr std::size_t kMaxMeshTriangles = 100'000;  ///< of all meshes and convex bodies together

// Ranges that several parts share. They only keep numbers where float arithmetic makes sense: sheets of 1 mm
// to 10 km, from spider silk to steel.
inline constexpr Range kPosition{-1e4, 1e4, "m"};
inline constexpr Range kLength{1e-4, 1e4, "m"};
inline constexpr Range kVelocity{-1e3, 1e3, "m/s"};
inline constexpr Range kLevel{kMinLevel, kMaxLevel};
inline constexpr Range kComponent{-1e6, 1e6};  ///< of a direction, whose length does not matter

/// Where a scene's other files are, if it is a file itself.
using SceneFolder = std::optional<std::filesystem::path>;
/// A cloth, and what it looks like.
ClothDescription read_cloth(const nlohmann::json& value, const std::string& path, Report& report,
                            const SceneFolder& folder, MotionFiles& motions, Look& look);
/// Where a cloth's nodes start that takes them from a file: what "nodes" says where it is an object. The
/// cloth's name, cells and levels have been read. Empty, and problems, if they cannot be read.
std::vector<Vec3> read_start(const nlohmann::json& value, const std::string& path, Report& report,
                             const SceneFolder& folder, const ClothDescription& cloth);
/// `value` is nullptr where the scene does not say; then, and for what it leaves out, the look is that of the
/// fabric that `material` names, if there is one and it does.
Look read_look(const nlohmann::json* value, const std::string& path, Report& report,
               const nlohmann::json* material);
/// Adds a ball or an obstacle to the simulation.
void read_collider(const nlohmann::json& value, const std::string& path, Report& report,
                   const SceneFolder& folder, MotionFiles& motions, SimulationDescription& simulation);
/// A collider's surface of at most `room` triangles: that of a `mesh`, or the hull of a `convex` body.
MeshDescription read_mesh(Object& object, bool convex, std::size_t room, const SceneFolder& folder);
/// {"axis", "degrees"} or {"quaternion": [w, x, y, z]}.
Quaternion read_orientation(const nlohmann::json& value, const std::string& path, Report& report);
/// The object's "orientation", if it has one.
Quaternion read_turn(Object& object, const Quaternion& otherwise);
struct WaypointPath {
  std::vector<Waypoint> points;
  bool loop = false;
};
/// The owner's "path" and "loop", if it has them: points at ascending times, their places under the key
/// `place`.
WaypointPath read_path(Object& owner, const char* place);
/// The same of an obstacle. Its points have the `orientation` that they do not give themselves; without one
/// they cannot have any.
void read_pose_path(Object& owner, const Quaternion* orientation, ObstacleDescription& obstacle);
/// A node's way through a clip of a motion's file: what "motion" says where it is an object. No points, and
/// problems, if it cannot be read.
struct PosePath {
  std::vector<PoseWaypoint> points;
  bool loop = false;
};
PosePath read_motion(const nlohmann::json& value, const std::string& path, Report& report,
                     MotionFiles& motions);
std::optional<EffectDescription> read_effect(const nlohmann::json& value, const std::string& path,
                                             Report& report);
Wind read_wind(const nlohmann::json& value, const std::string& path, Report& report);
IntegratorDescription read_integrator(const nlohmann::json& value, const std::string& path, Report& report);
Quality read_quality(const nlohmann::json& value, const std::string& path, Report& report);
LevelPolicy read_level_policy(const nlohmann::json& value, const std::string& path, Report& report);

/// As above, of a document that has been read. `found` are problems its text had, `overflows` see Document.
Result read_scene(const nlohmann::json& document, std::string_view name, const SceneFolder& folder,
                  std::vector<Problem> found, std::map<std::string, std::string> overflows);

}  // namespace weft::scene
