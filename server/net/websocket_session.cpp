#include "net/websocket_session.h"

#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_suffix.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "host/connection.h"
#include "net/gated_stream.h"
#include "net/outgoing_message.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using beast::error_code;

namespace {

constexpr auto kHandshakeTime = std::chrono::seconds(5);
/// A viewer that neither sends nor answers pings for so long is gone.
constexpr auto kIdleTime = std::chrono::seconds(60);
/// For a viewer to take what it is sent last, and to answer the close.
constexpr auto kCloseTime = std::chrono::seconds(2);
/// Between two measurements of the way to a viewer.
constexpr auto kPingPeriod = std::chrono::seconds(1);
constexpr const char* kPingText = "way";
constexpr std::uint16_t kTooManyMessages = 4003, kDoesNotRead = 4004, kSceneEnded = 4005;

/// Frames wait here, where newer ones replace them, and not in the kernel, where they grow old: 4 MB
/// otherwise.
void keep_kernel_queue_short(TcpSocket& socket) {
  error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(64 * 1024), ignored);
  const int unsent = 16 * 1024;
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent, sizeof unsent);
}

}  // namespace

/// One viewer's WebSocket: reads its messages into the host's Connection and writes what the host's Viewer
/// has for it, one message at a time.
class WebsocketSession : public std::enable_shared_from_this<WebsocketSession> {
 public:
  WebsocketSession(Context& context, Berth berth, ConnectionPool::Place place, Transport stream,
                   std::shared_ptr<host::SceneRunner> scene, protocol::Role role)
      : context_(context),
        berth_(std::move(berth)),
        place_(std::move(place)),
        ws_(std::move(stream), context.host.limits().messages_per_second),
        read_pause_(ws_.get_executor()),
        close_deadline_(ws_.get_executor()),
        way_timer_(ws_.get_executor()),
        connection_(context.host, std::move(scene), role, context.options.version) {
    berth_.loop().viewers.insert(this);
    ++context_.viewers;
  }

  ~WebsocketSession() {
    // The scene may keep the viewer a moment longer than the server's io_context lives.
    viewer().on_wake(nullptr);
    berth_.loop().viewers.erase(this);
    if (--context_.viewers == 0 && context_.stopping) context_.on_viewers_gone();
  }

  WebsocketSession(const WebsocketSession&) = delete;
  WebsocketSession& operator=(const WebsocketSession&) = delete;

  void start(const HttpRequest& request) {
    TcpStream& tcp = beast::get_lowest_layer(ws_);
    tcp.expires_never();  // the WebSocket has its own time limits
    keep_kernel_queue_short(tcp.socket());
    error_code ignored;
    const auto peer = tcp.socket().remote_endpoint(ignored);
    peer_ = peer.address().to_string() + ":" + std::to_string(peer.port());
    ws_.set_option(websocket::stream_base::timeout{kHandshakeTime, kIdleTime, true});
    ws_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, protocol::kSubprotocol);
      response.set(http::field::server, "weft");
    }));
    ws_.next_layer().show_texts_to(
        [this](std::string_view text) { return connection_.take_plain_ack(text); });
    ws_.read_message_max(context_.host.limits().message_bytes);
    // Called as long as messages are read, which holds the session.
    ws_.control_callback(
        [this](websocket::frame_type kind, beast::string_view text) { on_control(kind, text); });
    connection_.viewer().on_wake([weak = weak_from_this(), &loop = berth_.loop()] { loop.wake(weak); });
    ws_.async_accept(request, [self = shared_from_this()](error_code error) { self->on_accept(error); });
  }

  /// Sends the control messages that still wait if `drain`, then closes.
  void close(std::uint16_t code, const char* reason, bool drain) {
    if (closing_) return;
    closing_ = websocket::close_reason(static_cast<websocket::close_code>(code), reason);
    drain_ = drain;
    close_deadline_.expires_after(kCloseTime);
    close_deadline_.async_wait([weak = weak_from_this()](error_code error) {
      const auto self = weak.lock();
      if (!error && self) beast::get_lowest_layer(self->ws_).close();
    });
    pump();
  }

  /// Writes what waits, one message at a time, unless one is being written.
  void pump() {
    if (!closing_ && viewer().overflowed()) cut_off(kDoesNotRead, "control messages are not read");
    while (accepted_ && !writing_ && !close_sent_) {
      if (closing_ && !drain_) return send_close();
      auto next = viewer().take();
      while (closing_ && next && !next->text) next = viewer().take();  // no frames any more
      if (closing_ && !next) return send_close();
      if (!next) return;
      outgoing_.take(std::move(*next));
      write_outgoing();
    }
  }

  host::Viewer& viewer() { return connection_.viewer(); }
  const host::SceneRunner& scene() const { return connection_.scene(); }

 private:
  void on_accept(error_code error) {
    if (error) return;
    if (const auto more = context_.arrivals.admit(std::chrono::steady_clock::now()))
      spdlog::info("viewer {}: joined {}{}", peer_, connection_.scene().name(), *more);
    accepted_ = true;
    read();
    pump();
    measure_way();
  }

  /// Now and every second, by a ping of the WebSocket.
  void measure_way() {
    if (viewer().ping()) ws_.async_ping(kPingText, [self = shared_from_this()](error_code) {});
    way_timer_.expires_after(kPingPeriod);
    way_timer_.async_wait([weak = weak_from_this()](error_code error) {
      const auto self = weak.lock();
      if (!error && self && !self->closing_) self->measure_way();
    });
  }

  void on_control(websocket::frame_type kind, beast::string_view text) {
    if (kind == websocket::frame_type::pong && text == kPingText) viewer().pong();
  }

  void read() {
    ws_.async_read(incoming_,
                   [self = shared_from_this()](error_code error, std::size_t) { self->on_read(error); });
  }

  void on_read(error_code error) {
    if (error) {
      if (const auto more = context_.arrivals.admit(std::chrono::steady_clock::now()))
        spdlog::info("viewer {}: gone ({}){}", peer_, why_gone(error), *more);
      if (ended_for_good(error)) connection_.part();
      // A write may still wait for a peer that is no longer there.
      beast::get_lowest_layer(ws_).close();
      close_deadline_.cancel();
      return;
    }
    auto pace = host::Connection::Pace::go_on;
    if (!closing_ && ws_.got_binary()) {
      close(websocket::close_code::unknown_data, "only text messages", true);
    } else if (!closing_) {
      const auto data = incoming_.data();
      pace = connection_.receive({static_cast<const char*>(data.data()), data.size()},
                                 std::chrono::steady_clock::now());
    }
    incoming_.clear();
    if (pace == host::Connection::Pace::go_on) return read();
    // Nothing more is read of it.
    if (pace == host::Connection::Pace::end)
      return cut_off(kTooManyMessages, "more messages a second than allowed, for too long");
    // A flood is taken in no faster than what is allowed: the rest waits at its sender.
    read_pause_.expires_after(std::chrono::milliseconds(1000 / context_.host.limits().messages_per_second));
    read_pause_.async_wait([self = shared_from_this()](error_code) { self->read(); });
  }

  /// By the client's own close, or by this server's for what the client did: not where either goes away.
  bool ended_for_good(error_code error) const {
    if (closing_) return closing_->code != websocket::close_code::going_away;
    return error == websocket::error::closed && ws_.reason().code == websocket::close_code::normal;
  }

  std::string why_gone(error_code error) const {
    if (error == websocket::error::closed) return "closed, " + std::to_string(ws_.reason().code);
    return error.message();
  }

  /// Closes at once, for what the viewer does or does not do.
  void cut_off(std::uint16_t code, const char* reason) {
    if (const auto more = context_.refusals.admit(std::chrono::steady_clock::now()))
      spdlog::warn("viewer {}: closed, {}: {}{}", peer_, code, reason, *more);
    context_.host.metrics().closed_viewer(code);
    close(code, reason, false);
  }

  /// Most often all of it goes out at once, and nothing is left to wait for.
  void write_outgoing() {
    count_outgoing();
    const auto& buffers = outgoing_.buffers();
    const std::size_t sent = ws_.next_layer().write_at_once(buffers);
    if (sent == asio::buffer_size(buffers)) return outgoing_.clear();
    writing_ = true;
    beast::buffers_suffix<std::vector<asio::const_buffer>> rest(buffers);
    rest.consume(sent);
    ws_.next_layer().async_write_rest(
        rest, [self = shared_from_this()](error_code error, std::size_t) { self->on_written(error); });
  }

  void count_outgoing() {
    host::Metrics& metrics = context_.host.metrics();
    if (outgoing_.is_text()) {
      metrics.sent_text(outgoing_.payload());
    } else {
      metrics.sent_frame(outgoing_.payload());
    }
    const std::uint64_t dropped = viewer().dropped();
    if (dropped > dropped_) metrics.dropped_frames(dropped - std::exchange(dropped_, dropped));
  }

  void on_written(error_code error) {
    writing_ = false;
    outgoing_.clear();
    // After an error nothing more can be written; the read that is under way fails as well and ends the
    // session.
    if (!error) pump();
  }

  void send_close() {
    close_sent_ = true;
    ws_.async_close(*closing_, [self = shared_from_this()](error_code) { self->close_deadline_.cancel(); });
  }

  Context& context_;
  Berth berth_;
  ConnectionPool::Place place_;
  websocket::stream<GatedStream> ws_;
  SteadyTimer read_pause_;
  SteadyTimer close_deadline_;
  SteadyTimer way_timer_;
  std::string peer_;
  beast::flat_buffer incoming_;
  OutgoingMessage outgoing_;   ///< what is being written
  std::uint64_t dropped_ = 0;  ///< frames, as far as they are counted
  std::optional<websocket::close_reason> closing_;
  bool accepted_ = false, writing_ = false, drain_ = false, close_sent_ = false;
  host::Connection connection_;
};

namespace {

/// A session that ends takes itself out of the set.
std::vector<WebsocketSession*> copy_of_viewers(const NetworkLoop& loop) {
  return {loop.viewers.begin(), loop.viewers.end()};
}

}  // namespace

void start_websocket_session(Context& context, Berth berth, ConnectionPool::Place place, Transport stream,
                             const HttpRequest& request, std::shared_ptr<host::SceneRunner> scene,
                             protocol::Role role) {
  std::make_shared<WebsocketSession>(context, std::move(berth), std::move(place), std::move(stream),
                                     std::move(scene), role)
      ->start(request);
}

void end_websocket_sessions(NetworkLoop& loop) {
  const host::Text notice = host::make_text(protocol::notice_text("shutdown", "the server stops"));
  for (WebsocketSession* viewer : copy_of_viewers(loop)) {
    viewer->viewer().send(notice);
    viewer->close(websocket::close_code::going_away, "the server stops", true);
  }
}

void end_websocket_sessions_in(Context& context, const std::shared_ptr<const host::SceneRunner>& scene) {
  for (const auto& loop : context.loops) {
    asio::post(loop->io(), [&loop = *loop, scene] {
      for (WebsocketSession* viewer : copy_of_viewers(loop)) {
        if (&viewer->scene() == scene.get()) viewer->close(kSceneEnded, "the scene was ended", true);
      }
    });
  }
}

void send_what_waits(WebsocketSession& session) { session.pump(); }

void silence_websocket_session(WebsocketSession& session) { session.viewer().on_wake(nullptr); }

}  // namespace weft::net
