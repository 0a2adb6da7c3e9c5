#pragma once
/// The other end: a blocking client of PROTOCOL.md for the command line and for tests.
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weft::net {

/// "ws://host:port/path" or "http://host:port/path", taken apart.
struct Url {
  std::string host;
  std::string port = "80";
  std::string target = "/";

  /// Throws std::invalid_argument if `text` is not such a URL.
  static Url parse(std::string_view text);
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
HttpReply http_get(const Url& url, std::chrono::milliseconds limit);

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
  Client(const Url& url, std::chrono::milliseconds limit);
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
