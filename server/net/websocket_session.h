#pragma once
#include "net/context.h"
#include "net/request_rules.h"
#include "net/transport.h"

namespace weft::net {

/// Makes the connection a WebSocket of `scene`, where a place is reserved for it, that may do what `role`
/// may.
void start_websocket_session(Context& context, ConnectionPool::Place place, Transport stream,
                             const HttpRequest& request, host::SceneRunner& scene, protocol::Role role);

/// Tells a viewer that the server stops, and closes with 1001.
void end_websocket_session(WebsocketSession& session);

/// From now on the scene's thread leaves this session alone.
void silence_websocket_session(WebsocketSession& session);

}  // namespace weft::net
