#pragma once
/// A TCP connection, with TLS on it or without: what HTTP and WebSockets run on, at both ends.
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/core/role.hpp>

#include "net/erased_operation.h"

namespace weft::net {

/// What connections run on. Named, where Boost's own `tcp_stream` and `steady_timer` find it out at each
/// operation, which takes as long as a small message's way through all layers.
using Executor = boost::asio::io_context::executor_type;
using TcpSocket = boost::asio::basic_stream_socket<boost::asio::ip::tcp, Executor>;
using TcpStream =
    boost::beast::basic_stream<boost::asio::ip::tcp, Executor, boost::beast::unlimited_rate_policy>;
using SteadyTimer =
    boost::asio::basic_waitable_timer<std::chrono::steady_clock,
                                      boost::asio::wait_traits<std::chrono::steady_clock>, Executor>;

class Transport {
 public:
  using next_layer_type = TcpStream;
  using executor_type = next_layer_type::executor_type;
  using error_code = boost::beast::error_code;
  using Tls = boost::asio::ssl::stream<next_layer_type&>;

  explicit Transport(next_layer_type stream) : layers_(std::make_unique<Layers>(std::move(stream))) {}

  executor_type get_executor() { return tcp().get_executor(); }
  next_layer_type& next_layer() { return tcp(); }
  const next_layer_type& next_layer() const { return layers_->tcp; }

  /// From now on what is sent and received is encrypted; shake_hands() comes next.
  Tls& begin_tls(std::shared_ptr<boost::asio::ssl::context> context);
  /// TLS's handshake; `received`: what has been read of the other side's part. handler(error_code, how much
  /// of that was used).
  void shake_hands(boost::asio::ssl::stream_base::handshake_type side, boost::asio::const_buffer received,
                   AnyHandler handler);
  bool has_tls() const { return layers_->tls.has_value(); }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    read_some(BufferList<boost::asio::mutable_buffer>::of(buffers), std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    write_some(BufferList<boost::asio::const_buffer>::of(buffers), std::forward<Handler>(handler));
  }

  /// Says that nothing more is sent, within the time that the TCP stream has; handler(error_code).
  void async_end(AnyHandler handler);
  /// A WebSocket right on it calls this at its end.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type, Transport& transport, Handler&& handler) {
    transport.async_end(std::forward<Handler>(handler));
  }

 private:
  struct Layers {
    explicit Layers(next_layer_type stream) : tcp(std::move(stream)) {}
    next_layer_type tcp;
    std::shared_ptr<boost::asio::ssl::context> context;
    std::optional<Tls> tls;
  };

  next_layer_type& tcp() { return layers_->tcp; }
  void read_some(const BufferList<boost::asio::mutable_buffer>& buffers, AnyHandler handler);
  void write_some(const BufferList<boost::asio::const_buffer>& buffers, AnyHandler handler);

  std::unique_ptr<Layers> layers_;  ///< the TLS stream refers to the TCP stream
};

}  // namespace weft::net
