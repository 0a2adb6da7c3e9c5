#pragma once
/// A scene of a server as C++ programs see it (PROTOCOL.md): commands, their answers, and the newest frame.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
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
  bool coarser = false;                   ///< where the link carries too few frames levels may be coarser
  bool compact = true;                    ///< frames a fifth smaller, whose decoding takes longer
  std::chrono::milliseconds limit{5000};  ///< to connect, and for each answer
  ClientSecurity security;
  /// A connection that breaks is made again, tried after 0.25, 0.5, 1 s and so on to 10 s: at the same
  /// camera, with what this client held if that is within 5 s.
  bool reconnect = false;
  /// Hears every control message, answers as well, and its text; may post, and must not ask.
  std::function<void(const nlohmann::json& message, std::string_view text)> on_message;
};

/// One client of one scene; for one thread. Throws ConnectionError when the connection has ended,
/// RefusedError if the server refuses its `hello`, and std::runtime_error where the server does not keep to
/// the protocol. With `reconnect` a connection that has ended is made again within next_frame() and ask(); a
/// command on its way then fails with ConnectionError all the same.
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
  /// The same for a message of the caller's making, which keeps an id of its own. It is not done again after
  /// a reconnection.
  void post(nlohmann::json message);

  /// The newest frame that has not been taken yet, or else the next one; it is acknowledged, so that the
  /// server sends only as fast as frames are taken. What has waited in vain while this program did something
  /// else is passed over for a newer one, if there is one within 0.2 s. Nothing if none has come by `until`;
  /// an attempt to connect that has begun by then may take `limit` longer.
  std::optional<Received> next_frame(TimePoint until);

  /// The newest `scene` message; null until it has come, which is before the first answer.
  const nlohmann::json& scene() const { return scene_; }
  /// False between the end of a connection and the next.
  bool connected() const { return client_ != nullptr; }
  /// Capabilities that the server has agreed to; empty until it has.
  const std::vector<std::string>& capabilities() const { return capabilities_; }

  /// Says good-bye and waits a little for the answer. No connection is made again.
  void close();

 private:
  /// What a connection that broke had: a scene, and the seat in it by which its hands may be had.
  struct Seat {
    std::string scene, token;
  };

  /// Tells frames that have waited because this side stood still from those whose way is long, or which it
  /// takes seldom.
  class Arrivals {
   public:
    /// Whether a frame sent at `server_ms` is taken later than the one before it was, by more than 0.1 s, or
    /// of a side that takes them seldom by twice its pace.
    bool late(std::uint32_t server_ms) const;
    void taken(std::uint32_t server_ms);

   private:
    std::optional<std::uint32_t> last_;  ///< when it was taken, ms, modulo 2^32
    std::uint32_t usual_ = 0;            ///< from its sending to that, both clocks' difference included, ms
    std::uint32_t pace_ = 0;             ///< from the one before to it, ms
  };

  void connect();
  /// Connects again as it was, in the times between attempts; whether that was done by `until`.
  bool come_back(TimePoint until);
  /// Where it was before, as far as that can be.
  void restore();
  /// The connection has ended.
  void lose(const char* why);
  void plan_attempt();
  bool comes_back() const { return options_.reconnect && !closed_; }
  /// Waits until newest_ holds the newest that has come; whether it does by `until`.
  bool read_frame(TimePoint until);
  /// newest_ decoded and acknowledged.
  Received take_newest();
  // Both lose a connection that ends meanwhile, and throw.
  std::optional<Client::Message> receive(TimePoint until);
  void send(const std::string& text);
  /// Waits for the answer to what was posted under this id.
  nlohmann::json await(std::int64_t id);
  /// What is to be known of a command when its answer has come, or when it is sent.
  void remember(const protocol::Command& command);
  void take(Client::Message message);
  void take_control(std::string_view text);
  void take_answer(const nlohmann::json& message);

  Url url_;
  SceneClientOptions options_;
  std::unique_ptr<Client> client_;                  ///< null while there is no connection
  std::string ended_ = "the connection has ended";  ///< why
  std::int64_t last_id_ = 0;
  nlohmann::json scene_;
  std::int64_t asked_ = 0;            ///< id of the command whose answer is waited for; 0: none
  nlohmann::json answer_;             ///< null until it has come
  std::vector<std::uint8_t> newest_;  ///< empty: no frame waits
  Arrivals arrivals_;

  std::int64_t hello_ = 0;  ///< its id, until it is answered
  std::vector<std::string> capabilities_;
  bool acks_ = false;  ///< flow.ack is agreed on

  // For the next connection.
  bool closed_ = false;  ///< by close()
  int attempts_ = 0;     ///< since there was a connection
  TimePoint next_attempt_{};
  std::minstd_rand random_{std::random_device{}()};
  std::optional<protocol::Camera> camera_;                       ///< as it was told last
  std::optional<std::pair<std::int64_t, std::string>> joining_;  ///< a scene.join's id, and the scene
  std::set<std::uint32_t> held_;                                 ///< ids of grabs that it has not let go of
  std::vector<Seat> seats_;                                      ///< by which they may be had
};

}  // namespace weft::net
