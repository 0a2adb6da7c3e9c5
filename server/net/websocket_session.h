#pragma once
#include "net/context.h"
#include "net/request_rules.h"
#include "net/transport.h"

namespace weft::net {

/// Makes the connection a WebSocket of `scene`, where a place is reserved for it, that may do what `role`
/// may.
void start_websocket_session(Context& context, ConnectionPool::Place place, Transport stream,
                             const HttpRequest& request, std::shared_ptr<host::SceneRunner> scene,
                             protocol::Role role);

/// Tells a viewer that the server stops, and closes with 1001.
void end_websocket_session(WebsocketSession& session);

/// Ends those that are in the scene, which is no more: 4005.
void end_websocket_sessions_in(Context& context, const host::SceneRunner& scene);

/// From now on the scene's thread leaves this session alone.
void silence_websocket_session(WebsocketSession& session);

}  // namespace weft::net
