#pragma once
#include <algorithm>
#include <chrono>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/role.hpp>

#include "net/frame_gate.h"
#include "net/transport.h"

namespace weft::net {

/// The layer below a boost::beast::websocket::stream. Reads go through a FrameGate. The WebSocket writes its
/// own frames (pings, pongs, closes); messages are written here beside it, whole, and never in the midst of
/// another frame.
class GatedStream {
 public:
  using next_layer_type = Transport;
  using executor_type = next_layer_type::executor_type;
  using error_code = boost::beast::error_code;

  GatedStream(next_layer_type stream, int frames_per_second)
      : stream_(std::move(stream)),
        gate_(frames_per_second, FrameGate::TimePoint::clock::now()),
        turn_(stream_.get_executor(), SteadyTimer::time_point::max()) {}

  executor_type get_executor() { return stream_.get_executor(); }
  next_layer_type& next_layer() { return stream_; }
  const next_layer_type& next_layer() const { return stream_; }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_compose<Handler, void(error_code, std::size_t)>(Read<Buffers>{*this, buffers},
                                                                              handler, stream_);
  }
  /// Of the WebSocket: writes all of it, which is one frame.
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_compose<Handler, void(error_code, std::size_t)>(
        Write<Buffers>{*this, buffers, true}, handler, stream_);
  }
  /// As much of a message as goes out at once, bytes; the rest has to follow by async_write_rest() before
  /// anything else. 0 where TLS is spoken, and after an error, which the rest meets as well.
  template <class Buffers>
  std::size_t write_at_once(const Buffers& buffers) {
    if (busy_ || closed_ || stream_.has_tls()) return 0;
    error_code error;
    TcpSocket& socket = stream_.next_layer().socket();
    if (!socket.non_blocking()) socket.non_blocking(true, error);
    return error ? 0 : socket.send(buffers, 0, error);
  }
  /// handler(error_code, std::size_t), never within this call. Only one at a time.
  template <class Buffers, class Handler>
  auto async_write_rest(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_compose<Handler, void(error_code, std::size_t)>(
        Write<Buffers>{*this, buffers, false}, handler, stream_);
  }
  /// FrameGate::show_texts_to.
  void show_texts_to(FrameGate::Take take) { gate_.show_texts_to(std::move(take)); }
  /// Ends the connection after the last that was sent, as a server: the WebSocket calls it.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type, GatedStream& gated, Handler&& handler) {
    boost::asio::async_compose<Handler, void(error_code)>(Teardown{gated}, handler, gated.stream_);
  }

 private:
  static constexpr auto kTeardownTime = std::chrono::seconds(2);
  static constexpr std::size_t kTeardownBytes = std::size_t{256} * 1024;

  /// Receives until something may be handed on, and hands it on.
  template <class Buffers>
  struct Read {
    GatedStream& gated;
    Buffers buffers;
    enum { started, receiving, ready } step = started;

    template <class Operation>
    void operator()(Operation& operation, error_code error = {}, std::size_t count = 0) {
      FrameGate& gate = gated.gate_;
      if (step == receiving) {
        if (error) return operation.complete(error, 0);
        gate.received(count, FrameGate::TimePoint::clock::now());
      }
      if (gate.ready().empty() && !gate.shut()) {
        step = receiving;
        const auto room = gate.room();
        return gated.stream_.async_read_some(boost::asio::buffer(room.data(), room.size()),
                                             std::move(operation));
      }
      // Never from within the call that starts the operation.
      if (std::exchange(step, ready) == started)
        return boost::asio::post(gated.get_executor(), std::move(operation));
      if (gate.ready().empty()) return operation.complete(boost::asio::error::eof, 0);
      const auto handed_on =
          boost::asio::buffer_copy(buffers, boost::asio::buffer(gate.ready().data(), gate.ready().size()));
      gate.taken(handed_on);
      operation.complete({}, handed_on);
    }
  };

  /// Writes all when nobody else does. Nothing follows a close.
  template <class Buffers>
  struct Write {
    GatedStream& gated;
    Buffers buffers;
    bool of_websocket;
    enum { started, waiting, writing } step = started;

    template <class Operation>
    void operator()(Operation& operation, error_code error = {}, std::size_t count = 0) {
      if (step == writing) {
        gated.busy_ = false;
        gated.turn_.cancel();
        return operation.complete(error, count);
      }
      // The timer never expires: it is cancelled when the turn comes.
      const bool first = std::exchange(step, waiting) == started;
      if (gated.busy_) return gated.turn_.async_wait(std::move(operation));
      if (gated.closed_) {
        if (first) return boost::asio::post(gated.get_executor(), std::move(operation));
        return operation.complete(boost::asio::error::operation_aborted, 0);
      }
      step = writing;
      gated.busy_ = true;
      gated.closed_ = of_websocket && begins_close(buffers);
      boost::asio::async_write(gated.stream_, buffers, std::move(operation));
    }

    static bool begins_close(const Buffers& frame) {
      constexpr unsigned char kFinalClose = 0x88;
      unsigned char first = 0;
      return boost::asio::buffer_copy(boost::asio::buffer(&first, 1), frame) == 1 && first == kFinalClose;
    }
  };

  /// What still comes is read and thrown away, within limits: a socket that is closed with something unread
  /// takes back what has not reached its peer yet, most of all why it is closed.
  struct Teardown {
    GatedStream& gated;
    std::size_t bytes_left = kTeardownBytes;
    bool started = false;

    template <class Operation>
    void operator()(Operation& operation, error_code error = {}, std::size_t count = 0) {
      Transport& transport = gated.stream_;
      TcpStream& stream = transport.next_layer();
      if (!std::exchange(started, true)) {
        stream.expires_after(kTeardownTime);
        return transport.async_end(std::move(operation));
      }
      bytes_left -= std::min(bytes_left, count);
      if (!error && bytes_left > 0) {
        const auto room = gated.gate_.room();
        return stream.async_read_some(boost::asio::buffer(room.data(), room.size()), std::move(operation));
      }
      stream.close();
      operation.complete({});
    }
  };

  next_layer_type stream_;
  FrameGate gate_;
  SteadyTimer turn_;     ///< on which a write waits for another to end
  bool busy_ = false;    ///< a frame is being written
  bool closed_ = false;  ///< the WebSocket has begun to write its close
};

}  // namespace weft::net
