#include "protocol/message.h"

#include <utility>

#include "protocol/command_reader.h"
#include "protocol/strict_json.h"

namespace weft::protocol {
namespace {

using nlohmann::json;
/// Keeps the order of insertion, so that `op` and `re` lead the text.
using nlohmann::ordered_json;

std::string dump(const ordered_json& message) {
  return message.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void merge(ordered_json& message, const json& extra) {
  for (const auto& [name, value] : extra.items()) message[name] = value;
}

}  // namespace

std::variant<Request, Error> parse_request(std::string_view text, const Limits& limits) {
  if (text.size() > limits.message_bytes) {
    return Error{{},
                 "too_large",
                 "",
                 "the message has " + std::to_string(text.size()) +
                     " bytes; allowed: " + std::to_string(limits.message_bytes)};
  }
  StrictJson read = read_strictly(text, limits.json_depth);
  if (read.fault) return Error{read.id, read.fault->code, read.fault->path, read.fault->message};

  Request request;
  if (auto fault = read_command(read.tree, request)) {
    return Error{read.id, std::move(fault->code), std::move(fault->path), std::move(fault->message)};
  }
  return request;
}

std::string to_text(const Request& request) {
  ordered_json message;
  write_command(request, message);
  return dump(message);
}

std::string ok_text(std::int64_t re, std::uint64_t frame, const json& extra) {
  ordered_json message{{"op", "ok"}, {"re", re}, {"f", frame}};
  merge(message, extra);
  return dump(message);
}

std::string error_text(const Error& error) {
  ordered_json message{{"op", "error"}};
  if (error.re) message["re"] = *error.re;
  message["code"] = error.code;
  message["path"] = error.path;
  message["message"] = error.message;
  return dump(message);
}

std::string pong_text(std::optional<std::int64_t> re, double t, std::uint64_t frame, double time,
                      std::uint32_t server_ms) {
  ordered_json message{{"op", "pong"}};
  if (re) message["re"] = *re;
  message["t"] = t;
  message["f"] = frame;
  message["time"] = time;
  message["server_ms"] = server_ms;
  return dump(message);
}

std::string welcome_text(std::string_view server_version, std::string_view instance, Role role,
                         const Limits& limits) {
  return dump({{"op", "welcome"},
               {"protocol", kSubprotocol},
               {"minor", 18},
               {"server", "weft " + std::string(server_version)},
               {"instance", instance},
               {"role", name_of(role)},
               {"caps", kCapabilities},
               {"limits",
                {{"message_bytes", limits.message_bytes},
                 {"json_depth", limits.json_depth},
                 {"messages_per_second", limits.messages_per_second},
                 {"balls", limits.balls},
                 {"grabs", limits.grabs},
                 {"viewers", limits.viewers},
                 {"frame_bytes", limits.frame_bytes}}}});
}

std::string event_text(std::string_view kind, std::uint64_t frame, const json& what) {
  ordered_json message{{"op", "event"}, {"kind", kind}, {"f", frame}};
  merge(message, what);
  return dump(message);
}

std::string notice_text(std::string_view code, std::string_view message) {
  return dump({{"op", "notice"}, {"code", code}, {"message", message}});
}

}  // namespace weft::protocol
