#pragma once
/// What the sessions of one server share, on whichever of its network threads they are.
#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/thread_pool.hpp>

#include "net/access.h"
#include "net/connection_pool.h"
#include "net/log_limiter.h"
#include "net/network_loop.h"
#include "net/server.h"
#include "net/static_files.h"
#include "net/tls.h"

namespace weft::net {

/// Who may do what, and with which certificate.
struct Secrets {
  Access access;
  TlsContext tls;  ///< nullptr: without a certificate
};

/// Those that hold now. Any thread may use it; who has taken some keeps to them.
class CurrentSecrets {
 public:
  std::shared_ptr<const Secrets> get() const {
    const std::lock_guard lock(mutex_);
    return secrets_;
  }
  void set(Secrets secrets) {
    auto next = std::make_shared<const Secrets>(std::move(secrets));
    const std::lock_guard lock(mutex_);
    secrets_ = std::move(next);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Secrets> secrets_ = std::make_shared<const Secrets>();
};

struct Context {
  Context(host::Host& h, ServerOptions o)
      : host(h),
        options(std::move(o)),
        files(options.web),
        connections(options.max_connections, options.max_connections_per_address) {
    for (int i = 0; i < std::max(1, options.network_threads); ++i)
      loops.push_back(std::make_unique<NetworkLoop>());
  }

  host::Host& host;
  const ServerOptions options;
  CurrentSecrets secrets;
  StaticFiles files;
  ConnectionPool connections;
  boost::asio::thread_pool makers{1};  ///< where scenes are made for clients, one at a time
  LogLimiter arrivals, refusals;  ///< of lines on viewers that come and go, and on those that are not let
  std::atomic<std::size_t> viewers = 0;
  std::atomic<bool> stopping = false;
  /// Called, by the loop that it was on, when the last viewer has gone while stopping.
  std::function<void()> on_viewers_gone;
  /// One a network thread. Last: the sessions that their handlers hold use all of the above.
  std::vector<std::unique_ptr<NetworkLoop>> loops;
};

}  // namespace weft::net
