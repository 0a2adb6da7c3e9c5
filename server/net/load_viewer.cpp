#include "net/load_viewer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/frame.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

namespace {

constexpr double kServersRate = 60;           // frames a second, at most
constexpr double kClockWraps = 4294967296.0;  // ms: frames have its low 32 bits

double now_ms() { return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count(); }

}  // namespace

LoadViewer::LoadViewer(asio::io_context& io, const Url& url, const ClientSecurity& security, TlsContext tls,
                       const Manner& manner, LoadTally& tally)
    : ws_(TcpStream(io)),
      pause_(io),
      tls_(std::move(tls)),
      url_(url),
      security_(security),
      manner_(manner),
      tally_(tally) {}

void LoadViewer::join(const tcp::resolver::results_type& where) {
  beast::get_lowest_layer(ws_).expires_after(kJoinTime);
  beast::get_lowest_layer(ws_).async_connect(
      where, [self = shared_from_this()](error_code error, const tcp::endpoint&) {
        if (error) return self->fail("connecting", error);
        if (self->tls_) return self->begin_tls();
        self->shake_hands();
      });
}

void LoadViewer::leave() {
  leaving_ = true;
  beast::get_lowest_layer(ws_).close();
  pause_.cancel();
}

void LoadViewer::begin_tls() {
  begin_client_tls(ws_.next_layer(), tls_, url_, security_, [self = shared_from_this()](error_code error) {
    if (error) return self->fail("TLS", error);
    self->shake_hands();
  });
}

void LoadViewer::shake_hands() {
  beast::get_lowest_layer(ws_).expires_never();
  error_code ignored;
  beast::get_lowest_layer(ws_).socket().set_option(tcp::no_delay(true), ignored);
  ws_.set_option(websocket::stream_base::timeout{kJoinTime, websocket::stream_base::none(), false});
  ws_.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
    if (!security_.token.empty()) request.set(http::field::authorization, "Bearer " + security_.token);
    request.set(http::field::sec_websocket_protocol, protocol::kSubprotocol);
  }));
  ws_.read_message_max(std::size_t{64} << 20);
  ws_.async_handshake(response_, host_header(url_), url_.target,
                      [self = shared_from_this()](error_code error) {
                        if (error) return self->fail("joining", error);
                        self->greet();
                      });
}

void LoadViewer::greet() {
  // Where it takes fewer than there are, each when it is due: with two on the way two came at a time.
  say(protocol::Hello{"weft bench", {"flow.ack"}, takes_all() ? 2 : 1});
  say(protocol::Camera{manner_.distance, std::nullopt});
  asked_ms_ = now_ms();
  say(protocol::Ping{0});
  read();
}

void LoadViewer::say(const protocol::Command& command) {
  queue_.push_back(protocol::to_text({std::nullopt, command}));
  if (queue_.size() == 1) write();
}

void LoadViewer::write() {
  ws_.text(true);
  ws_.async_write(asio::buffer(queue_.front()), [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return;  // the read that is under way tells why
    self->queue_.pop_front();
    if (!self->queue_.empty()) self->write();
  });
}

void LoadViewer::read() {
  ws_.async_read(incoming_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->fail("reading", error);
    self->take();
    self->incoming_.clear();
    self->read();
  });
}

void LoadViewer::take() {
  const auto data = incoming_.data();
  const auto* bytes = static_cast<const std::uint8_t*>(data.data());
  if (ws_.got_text()) return take_text({reinterpret_cast<const char*>(bytes), data.size()});
  const auto stamp = protocol::read_stamp({bytes, data.size()});
  if (!stamp) return;
  if (!std::exchange(joined_, true)) {
    ++tally_.joined;
    ++tally_.settled;
  }
  if (tally_.measuring) {
    ++frames_;
    ++tally_.frames;
    tally_.bytes += data.size();
    if (!manner_.slow && clock_offset_) {
      const double age = std::fmod(now_ms() + *clock_offset_ - stamp->server_ms, kClockWraps);
      tally_.ages.push_back(age - kClockWraps * std::round(age / kClockWraps));
    }
  }
  // What it has shown before the next one is due.
  shown_ = stamp->frame;
  if (std::exchange(waits_, true)) return;
  pause_.expires_after(std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(manner_.slow ? 1.0 : std::max(0.0, next_due() - now_ms()) / 1e3)));
  pause_.async_wait([self = shared_from_this()](error_code error) {
    if (error) return;
    self->waits_ = false;
    self->due_ms_ = now_ms();
    self->say(protocol::Ack{self->shown_});
  });
}

bool LoadViewer::takes_all() const { return !manner_.slow && manner_.rate >= kServersRate; }

void LoadViewer::take_text(std::string_view text) {
  if (clock_offset_ || text.find("\"pong\"") == std::string_view::npos) return;
  const auto pong = nlohmann::json::parse(text, nullptr, false);
  if (!pong.is_object() || !pong.contains("server_ms")) return;
  clock_offset_ = pong["server_ms"].get<double>() - (asked_ms_ + now_ms()) / 2;
}

void LoadViewer::fail(const char* doing, error_code error) {
  if (leaving_) return;
  std::string why = std::string(doing) + ": " + error.message();
  if (error == websocket::error::upgrade_declined)
    why = "refused: " + std::to_string(response_.result_int()) + " " + response_.body();
  if (error == websocket::error::closed) why = "closed: " + std::to_string(ws_.reason().code);
  while (why.ends_with('\n')) why.pop_back();
  tally_.failures.push_back(std::move(why));
  if (!joined_) ++tally_.settled;
}

}  // namespace weft::net
