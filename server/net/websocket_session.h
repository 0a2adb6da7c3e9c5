#pragma once
#include "net/context.h"
#include "net/request_rules.h"
#include "net/transport.h"

namespace weft::net {

/// On the connection's network thread: makes it a WebSocket of `scene`, where a place is reserved for it,
/// that may do what `role` may.
void start_websocket_session(Context& context, Berth berth, ConnectionPool::Place place, Transport stream,
                             const HttpRequest& request, std::shared_ptr<host::SceneRunner> scene,
                             protocol::Role role);

/// On the loop's thread: tells its viewers that the server stops, and closes with 1001.
void end_websocket_sessions(NetworkLoop& loop);

/// Ends those that are in the scene, which is no more: 4005. From any thread, soon.
void end_websocket_sessions_in(Context& context, const std::shared_ptr<const host::SceneRunner>& scene);

/// On its loop's thread: the session looks what is to be sent.
void send_what_waits(WebsocketSession& session);

/// From now on the scene's thread leaves this session alone.
void silence_websocket_session(WebsocketSession& session);

}  // namespace weft::net
