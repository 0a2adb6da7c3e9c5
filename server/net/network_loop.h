#pragma once
/// The server's network threads: each has an event loop, and connections that never change to another.
#include <array>
#include <atomic>
#include <ctime>
#include <memory>
#include <unordered_set>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>

#include "host/wake_list.h"

namespace weft::net {

class HttpSession;
class WebsocketSession;

/// Connections beyond the limits that a loop keeps until they have asked for something: `/healthz` is
/// answered, anything else refused. Each further one ends the oldest of them.
inline constexpr std::size_t kExtraConnections = 64;

class NetworkLoop {
 public:
  boost::asio::io_context& io() { return io_; }
  /// Serves, on the calling thread, until io() is stopped.
  void run();

  /// The viewer has something to send, or must be closed: it looks soon. May be called from any thread.
  void wake(std::weak_ptr<WebsocketSession> viewer);
  /// Connections that it serves. May be called from any thread.
  int connections() const { return connections_; }
  /// Processor time of its thread, s; 0 before run(). May be called from any thread while it runs.
  double cpu() const;

  // What its own thread alone uses.
  std::unordered_set<WebsocketSession*> viewers;
  /// Those beyond the limits, in a ring.
  std::array<std::weak_ptr<HttpSession>, kExtraConnections> extra;
  std::size_t next_extra = 0;

 private:
  friend class Berth;

  std::atomic<int> connections_ = 0;
  std::atomic<clockid_t> clock_ = CLOCK_REALTIME;  ///< of its thread; until it runs that of no thread
  host::WakeList<WebsocketSession> woken_;
  boost::asio::io_context io_{1};  // last: its handlers use all of the above
};

/// What makes a connection one of a loop's.
class Berth {
 public:
  explicit Berth(NetworkLoop& loop) : loop_(&loop) { ++loop.connections_; }
  Berth(Berth&& other) noexcept : loop_(std::exchange(other.loop_, nullptr)) {}
  Berth& operator=(Berth&&) = delete;
  ~Berth() {
    if (loop_) --loop_->connections_;
  }
  NetworkLoop& loop() const { return *loop_; }

 private:
  NetworkLoop* loop_;
};

}  // namespace weft::net
