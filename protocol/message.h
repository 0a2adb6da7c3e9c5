#pragma once
/// Control messages of PROTOCOL.md sections 2 and 3: JSON text <-> values.
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/operations.h"
#include "protocol/role.h"

namespace weft::protocol {

inline constexpr const char* kSubprotocol = "weft.v1";
inline constexpr std::array<const char*, 3> kCapabilities{"flow.ack", "flow.level", "grid.rice"};

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
/// `instance` names this run of the server.
std::string welcome_text(std::string_view server_version, std::string_view instance, Role role,
                         const Limits& limits);
std::string event_text(std::string_view kind, std::uint64_t frame, const nlohmann::json& what);
std::string notice_text(std::string_view code, std::string_view message);

}  // namespace weft::protocol
