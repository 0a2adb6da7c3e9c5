#pragma once
/// Control messages of PROTOCOL.md sections 2 and 3: JSON text <-> values.
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace weft::protocol {

inline constexpr const char* kSubprotocol = "weft.v1";
inline constexpr std::array<const char*, 1> kCapabilities{"flow.ack"};

using Vector = std::array<double, 3>;
using Turn = std::array<double, 4>;  ///< w, x, y, z

/// Section 6, with its defaults.
struct Limits {
  std::size_t message_bytes = 16384;
  int json_depth = 16;
  int messages_per_second = 120;
  int balls = 64;
  int grabs = 64;
  int viewers = 256;
  std::size_t frame_bytes = 1048576;
};

struct Hello {
  std::string client;
  std::vector<std::string> caps;
  int window = 2;
};
struct SceneList {};
struct SceneJoin {
  std::string scene;
};
struct Camera {
  std::optional<double> distance = {};  ///< exactly one of the two
  std::optional<Vector> eye = {};
  /// With an eye, both or neither: what it looks at, another point, and how far from there it sees, rad.
  std::optional<Vector> target = {};
  std::optional<double> half_angle = {};
};
struct Ack {
  std::uint32_t frame = 0;
};
/// A ball's, "kinematic" or "dynamic" on the wire.
enum class Motion { kinematic, dynamic };
struct BallAdd {
  Vector position{};
  double radius = 0;
  Vector velocity{};
  Motion motion = Motion::kinematic;
  double mass = 1;
  double friction = 0;
};
struct BallMove {
  std::uint32_t ball = 0;
  Vector position{};
};
struct BallThrow {
  std::uint32_t ball = 0;
  Vector velocity{};
};
struct BallRemove {
  std::uint32_t ball = 0;
};
struct ObstacleMove {
  std::uint32_t obstacle = 0;  ///< its place in `scene`
  Vector position{};
  std::optional<Turn> quaternion;  ///< unit length after parsing; without one it keeps its turn
};
struct ObstacleThrow {
  std::uint32_t obstacle = 0;  ///< its place in `scene`
  Vector velocity{};
  Vector spin{};
};
struct ObstacleGrab {
  std::uint32_t obstacle = 0;      ///< its place in `scene`
  Vector point{};                  ///< what is held, from its centre along its own axes
  std::optional<Vector> position;  ///< of the hand; without one where the point is
  double max_force = 100;
};
struct ClothGrab {
  std::uint32_t cloth = 0;
  double u = 0, v = 0;
  std::optional<Vector> position;  ///< of the hand; without one where the cloth is
  double max_force = 100;
};
struct GrabMove {
  std::uint32_t grab = 0;
  Vector position{};
};
struct GrabRelease {
  std::uint32_t grab = 0;
};
struct ClothPin {
  std::uint32_t cloth = 0;
  double u = 0, v = 0;
};
struct ClothUnpin {
  std::uint32_t cloth = 0;
  double u = 0, v = 0;
};
/// A number, or an array of several.
using Numbers = std::vector<double>;
using Parameters = std::map<std::string, Numbers>;  ///< by name, at least one
struct ClothTune {
  std::uint32_t cloth = 0;
  Parameters parameters;
};
/// Of what cloth slides on. At most one of the two; without either of every ball and obstacle.
struct FrictionSet {
  double friction = 0;
  std::optional<std::uint32_t> ball = {};
  std::optional<std::uint32_t> obstacle = {};  ///< its place in `scene`
};
struct EffectSet {
  std::string effect;
  bool on = true;
};
struct EffectTune {
  std::string effect;
  Parameters parameters;
};
struct WindSet {
  Vector direction{};  ///< unit length after parsing
  double speed = 0;
  std::optional<double> gusts = {};                          ///< intensity; without it that stays
  std::optional<double> turbulence = {};                     ///< the same
  std::optional<double> time_scale = {}, length_scale = {};  ///< of gusts, s, and turbulence, m; the same
};
struct WindZoneSet {
  std::uint32_t zone = 0;  ///< its place in the wind's zones
  Vector velocity{};
};
/// At most one of the two; without either the scene's own again.
struct Quality {
  std::optional<double> max_error;  ///< in cloth sizes
  std::optional<double> max_ms;
};
struct Cost {};
struct Pause {};
struct Resume {};
struct Reset {};
struct Step {
  int count = 1;
};
struct Ping {
  double t = 0;
};

using Command = std::variant<Hello, SceneList, SceneJoin, Camera, Ack, BallAdd, BallMove, BallThrow,
                             BallRemove, ObstacleMove, ObstacleThrow, ObstacleGrab, ClothGrab, GrabMove,
                             GrabRelease, ClothPin, ClothUnpin, ClothTune, FrictionSet, EffectSet, EffectTune,
                             WindSet, WindZoneSet, Quality, Cost, Pause, Resume, Reset, Step, Ping>;

struct Request {
  std::optional<std::int64_t> id;
  Command command;
};

/// Why a message was refused. `path` is a JSON pointer, `message` names field, value and allowed range.
struct Error {
  std::optional<std::int64_t> re;  ///< the request's id, where it could be read
  std::string code, path, message;
};

/// Reads one client message. Depth is limited before a tree is built; duplicate keys, unknown members, wrong
/// types, missing, non-finite and out-of-range values are errors. Never throws.
std::variant<Request, Error> parse_request(std::string_view text, const Limits& limits = {});

/// A client message as JSON text, the inverse of parse_request: for clients written in C++.
std::string to_text(const Request& request);

// Server messages. `extra` members are merged into the object.
std::string ok_text(std::int64_t re, std::uint64_t frame,
                    const nlohmann::json& extra = nlohmann::json::object());
std::string error_text(const Error& error);
/// `server_ms` is the server's clock as frames have it.
std::string pong_text(std::optional<std::int64_t> re, double t, std::uint64_t frame, double time,
                      std::uint32_t server_ms);
/// `server_version` alone, as in "0.1.0".
std::string welcome_text(std::string_view server_version, const Limits& limits);
std::string event_text(std::string_view kind, std::uint64_t frame, const nlohmann::json& what);
std::string notice_text(std::string_view code, std::string_view message);

}  // namespace weft::protocol
