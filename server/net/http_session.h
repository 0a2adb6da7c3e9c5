#pragma once
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "net/context.h"

namespace weft::net {

/// Serves one accepted connection until it ends or becomes a WebSocket.
void start_http_session(Context& context, boost::asio::ip::tcp::socket socket);

}  // namespace weft::net
