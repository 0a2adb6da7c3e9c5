#pragma once
/// A client's WebSocket, from the place of its server to messages. Nothing here waits: Client does, and
/// LoadViewer has hundreds. For net's .cpp files only.
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "net/client.h"
#include "net/tls.h"
#include "net/transport.h"

namespace weft::net {

/// Connects within `limit`, with TLS if there is a context; done(error_code). What comes later on the
/// transport has the same end of time.
void connect(Transport& transport, const boost::asio::ip::tcp::resolver::results_type& where, const Url& url,
             const ClientSecurity& security, TlsContext tls, std::chrono::milliseconds limit,
             AnyHandler done);
/// Why that failed.
std::string why_not_connected(const Transport& transport, const Url& url, boost::beast::error_code error);

/// Each operation has a `done(error_code)`, one of a kind is under way at a time, and the socket outlives it.
class ClientSocket {
 public:
  using error_code = boost::beast::error_code;

  /// `url` and `security` must outlive it; `tls`: null without.
  ClientSocket(boost::asio::io_context& io, const Url& url, const ClientSecurity& security, TlsContext tls);

  /// Connects and shakes hands, each within `limit`.
  void open(const boost::asio::ip::tcp::resolver::results_type& where, std::chrono::milliseconds limit,
            AnyHandler done);
  /// `text` must be there until it is done.
  void write(std::string_view text, AnyHandler done);
  /// received() is then the next message, and text if is_text().
  void read(AnyHandler done);
  std::span<const std::uint8_t> received() const;
  bool is_text() const { return ws_.got_text(); }
  /// Says good-bye.
  void close(AnyHandler done);
  /// Ends at once; what is under way fails.
  void drop();

  /// What the error means of the last operation; `doing`: "reading", say.
  std::string why(std::string_view doing, error_code error) const;

 private:
  void shake_hands(std::chrono::milliseconds limit, AnyHandler done);

  boost::beast::websocket::stream<Transport> ws_;
  const Url& url_;
  const ClientSecurity& security_;
  const TlsContext tls_;
  enum class Stage { connecting, shaking_hands, open } stage_ = Stage::connecting;
  boost::beast::websocket::response_type response_;
  boost::beast::flat_buffer incoming_;
};

}  // namespace weft::net
