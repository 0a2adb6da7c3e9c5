#pragma once
/// The other end: a blocking client of PROTOCOL.md. For scenes SceneClient is the simpler one.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weft::net {

/// "ws://host:port/path" or "http://host:port/path", or with TLS "wss:" or "https:", taken apart.
struct Url {
  bool secure = false;
  std::string host;
  std::string port = "80";
  std::string target = "/";

  /// Throws std::invalid_argument if `text` is not such a URL.
  static Url parse(std::string_view text);
};

/// What a client shows, and whom it trusts.
struct ClientSecurity {
  std::string token;                  ///< empty: none
  std::filesystem::path authorities;  ///< certificates (PEM) trusted with TLS; empty: the system's
  /// False: whoever answers is taken for the server. To measure, not to be safe.
  bool check_certificate = true;
};

/// The server refused, closed, or cannot be reached; what() says which.
class ConnectionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct HttpReply {
  unsigned status = 0;
  std::string body;
};
/// Throws ConnectionError if there is no whole answer within `limit`.
HttpReply http_get(const Url& url, std::chrono::milliseconds limit, const ClientSecurity& security = {});

/// One WebSocket of a scene.
class Client {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Message {
    bool binary = false;
    std::vector<std::uint8_t> bytes;
    std::string_view text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
  };

  /// Connects. Throws ConnectionError, with the server's own words if it refuses.
  Client(const Url& url, std::chrono::milliseconds limit, const ClientSecurity& security = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view text);
  /// The next message, or nothing if none has come by `until`. Throws ConnectionError when the connection has
  /// ended.
  std::optional<Message> receive(TimePoint until);
  /// Says good-bye and waits a little for the answer.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::net
