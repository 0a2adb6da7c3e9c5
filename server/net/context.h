#pragma once
/// What the sessions of one server share. Everything here runs on the server's one network thread.
#include <array>
#include <functional>
#include <memory>
#include <unordered_set>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/thread_pool.hpp>

#include "net/access.h"
#include "net/connection_pool.h"
#include "net/log_limiter.h"
#include "net/server.h"
#include "net/static_files.h"
#include "net/tls.h"

namespace weft::net {

class HttpSession;
class WebsocketSession;

/// Connections beyond the limits that are kept until they have asked for something: `/healthz` is answered,
/// anything else refused. Each further one ends the oldest of them.
inline constexpr std::size_t kExtraConnections = 64;

struct Context {
  Context(host::Host& h, ServerOptions o)
      : host(h),
        options(std::move(o)),
        files(options.web),
        connections(options.max_connections, options.max_connections_per_address) {}

  host::Host& host;
  ServerOptions options;
  Access access;
  TlsContext tls;  ///< nullptr: without a certificate
  StaticFiles files;
  ConnectionPool connections;
  /// Those beyond the limits, in a ring.
  std::array<std::weak_ptr<HttpSession>, kExtraConnections> extra;
  std::size_t next_extra = 0;
  std::unordered_set<WebsocketSession*> viewers;
  boost::asio::thread_pool makers{1};  ///< where scenes are made for clients, one at a time
  LogLimiter arrivals, refusals;  ///< of lines on viewers that come and go, and on those that are not let
  bool stopping = false;
  std::function<void()> on_viewers_gone;  ///< called when the last viewer has gone while stopping
};

}  // namespace weft::net
