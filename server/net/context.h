#pragma once
/// What the sessions of one server share. Everything here runs on the server's one network thread.
#include <functional>
#include <unordered_set>
#include <utility>

#include "net/log_limiter.h"
#include "net/server.h"
#include "net/static_files.h"

namespace weft::net {

class WebsocketSession;

struct Context {
  Context(host::Host& h, ServerOptions o) : host(h), options(std::move(o)), files(options.web) {}

  host::Host& host;
  ServerOptions options;
  StaticFiles files;
  std::size_t connections = 0;
  std::unordered_set<WebsocketSession*> viewers;
  LogLimiter arrivals, refusals;  ///< of lines on viewers that come and go, and on those that are not let
  bool stopping = false;
  std::function<void()> on_viewers_gone;  ///< called when the last viewer has gone while stopping
};

/// Counts a connection as long as it lives.
class ConnectionCount {
 public:
  explicit ConnectionCount(Context& context) : context_(&context) { ++context.connections; }
  ConnectionCount(ConnectionCount&& other) noexcept : context_(std::exchange(other.context_, nullptr)) {}
  ConnectionCount& operator=(ConnectionCount&&) = delete;
  ~ConnectionCount() {
    if (context_) --context_->connections;
  }

 private:
  Context* context_;
};

}  // namespace weft::net
