#pragma once
#include <chrono>
#include <memory>
#include <string_view>

#include "host/host.h"
#include "host/rate_limiter.h"

namespace weft::host {

/// One client's side of the protocol, whatever carries it: reads its messages, answers those that concern the
/// connection, passes the others to its scene. One thread uses a connection; its viewer() may be used by any.
class Connection {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Enters `scene`, in which a place is reserved for it (SceneRunner::reserve): `welcome` is the first thing
  /// it sends. Commands that need more than `role` are refused.
  Connection(Host& host, std::shared_ptr<SceneRunner> scene, protocol::Role role,
             std::string_view server_version);
  /// Leaves the scene.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Viewer& viewer() { return *viewer_; }
  const std::shared_ptr<Viewer>& shared_viewer() const { return viewer_; }
  const SceneRunner& scene() const { return *scene_; }
  /// The connection ended as its client wished: it will not come back.
  void part() { parted_ = true; }

  /// What is to be done after a message.
  enum class Pace {
    go_on,      ///< read the next one
    slow_down,  ///< it came too fast and was dropped: read the next one later
    end         ///< too many came too fast: close the connection
  };
  /// Carries out what a viewer sends most, a plain acknowledgement of a frame that was sent (read_plain_ack);
  /// false for any other message, which receive() takes.
  bool take_plain_ack(std::string_view text);
  /// One text message of at most Limits::message_bytes.
  Pace receive(std::string_view text, TimePoint now);

 private:
  /// False, and the client is told, if its role does not do for the command.
  bool may_give(const protocol::Request& request);
  void answer(const protocol::Request& request, const protocol::Hello& hello);
  void answer(const protocol::Request& request, const protocol::SceneList& list);
  void answer(const protocol::Request& request, const protocol::SceneJoin& join);
  void answer(const protocol::Request& request, const protocol::Ack& ack);
  void answer(const protocol::Request& request, const protocol::Ping& ping);
  template <class Command>
  void answer(const protocol::Request& request, const Command& command);
  void ok(const protocol::Request& request, const nlohmann::json& extra);
  void send(std::string text);
  void too_many_wait(const protocol::Request& request);
  void refuse(const protocol::Request& request, const char* code, const char* path, std::string message);
  void refuse(const protocol::Error& error);

  Host& host_;
  std::shared_ptr<SceneRunner> scene_;
  const protocol::Role role_;
  std::shared_ptr<Viewer> viewer_ = std::make_shared<Viewer>();
  std::uint64_t visit_ = 0;
  bool parted_ = false;
  RateLimiter rate_;    ///< of messages
  RateLimiter excess_;  ///< of those dropped: half as many may be
};

}  // namespace weft::host
