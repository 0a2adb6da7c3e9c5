#pragma once
#include "net/context.h"
#include "net/transport.h"

namespace weft::net {

/// Serves one accepted connection until it ends or becomes a WebSocket. On the thread of its loop, whose
/// executor the socket has.
void start_http_session(Context& context, Berth berth, TcpSocket socket);

}  // namespace weft::net
