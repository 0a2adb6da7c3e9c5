#pragma once
/// A scene of a server as C++ programs see it (PROTOCOL.md): commands, their answers, and the newest frame.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "net/client.h"
#include "protocol/frame.h"
#include "protocol/operations.h"

namespace weft::net {

/// The server refused a command; what() is its message, which names the field, the value and what is allowed.
class RefusedError : public std::runtime_error {
 public:
  RefusedError(const std::string& message, std::string refused_code, std::string refused_path)
      : std::runtime_error(message), code(std::move(refused_code)), path(std::move(refused_path)) {}

  std::string code;  ///< one of PROTOCOL.md's
  std::string path;  ///< JSON pointer into the command
};

struct SceneClientOptions {
  std::string name = "weft client";       ///< told to the server
  int window = 4;                         ///< frames on their way that are not acknowledged, 1..8
  std::chrono::milliseconds limit{5000};  ///< to connect, and for each answer
  ClientSecurity security;
  /// Hears every control message, answers as well, and its text; may post, and must not ask.
  std::function<void(const nlohmann::json& message, std::string_view text)> on_message;
};

/// One connection to one scene; for one thread. Throws ConnectionError when the connection has ended, and
/// std::runtime_error where the server does not keep to the protocol.
class SceneClient {
 public:
  using TimePoint = Client::TimePoint;

  struct Received {
    protocol::Frame frame;
    std::size_t bytes = 0;  ///< of the message
  };

  /// Connects to ws://HOST:PORT/v1/scenes/NAME. Throws ConnectionError, with the server's words if it
  /// refuses.
  explicit SceneClient(const Url& url, SceneClientOptions options = {});

  /// Sends a command and waits for its answer. Throws RefusedError if it is an error.
  nlohmann::json ask(const protocol::Command& command);
  /// Sends a command; its answer, with the id that is returned, comes to `on_message`.
  std::int64_t post(const protocol::Command& command);
  /// The same for a message of the caller's making, which keeps an id of its own.
  void post(nlohmann::json message);

  /// The newest frame that has not been taken yet, or else the next one; it is acknowledged, so that the
  /// server sends only as fast as frames are taken. Nothing if none has come by `until`.
  std::optional<Received> next_frame(TimePoint until);

  /// The newest `scene` message; null until it has come, which is before the first answer.
  const nlohmann::json& scene() const { return scene_; }

  /// Says good-bye and waits a little for the answer.
  void close() { client_.close(); }

 private:
  void take(Client::Message message);
  void take_control(std::string_view text);

  SceneClientOptions options_;
  Client client_;
  std::int64_t last_id_ = 0;
  nlohmann::json scene_;
  std::int64_t asked_ = 0;            ///< id of the command whose answer is waited for; 0: none
  nlohmann::json answer_;             ///< null until it has come
  std::vector<std::uint8_t> newest_;  ///< empty: no frame waits
};

}  // namespace weft::net
