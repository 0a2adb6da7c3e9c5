#pragma once
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/beast/core/tcp_stream.hpp>

#include "net/context.h"
#include "net/request_rules.h"

namespace weft::net {

/// Makes the connection a WebSocket of `scene`, where a place is reserved for it.
void start_websocket_session(Context& context, ConnectionPool::Place place, boost::beast::tcp_stream stream,
                             const HttpRequest& request, host::SceneRunner& scene);

/// Tells a viewer that the server stops, and closes with 1001.
void end_websocket_session(WebsocketSession& session);

/// From now on the scene's thread leaves this session alone.
void silence_websocket_session(WebsocketSession& session);

}  // namespace weft::net
