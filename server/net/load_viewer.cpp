#include "net/load_viewer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/frame.h"

namespace weft::net {

using Clock = std::chrono::steady_clock;

namespace {

constexpr double kServersRate = 60;           // frames a second, at most
constexpr double kClockWraps = 4294967296.0;  // ms: frames have its low 32 bits

double now_ms() { return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count(); }

}  // namespace

LoadViewer::LoadViewer(boost::asio::io_context& io, const Url& url, const ClientSecurity& security,
                       TlsContext tls, const Manner& manner, LoadTally& tally)
    : socket_(io, url, security, std::move(tls)), pause_(io), manner_(manner), tally_(tally) {}

void LoadViewer::join(const boost::asio::ip::tcp::resolver::results_type& where) {
  socket_.open(where, kJoinTime, [self = shared_from_this()](error_code error) {
    if (error) return self->fail("joining", error);
    self->greet();
  });
}

void LoadViewer::leave() {
  leaving_ = true;
  socket_.drop();
  pause_.cancel();
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
  socket_.write(queue_.front(), [self = shared_from_this()](error_code error) {
    if (error) return;  // the read that is under way tells why
    self->queue_.pop_front();
    if (!self->queue_.empty()) self->write();
  });
}

void LoadViewer::read() {
  socket_.read([self = shared_from_this()](error_code error) {
    if (error) return self->fail("reading", error);
    self->take(self->socket_.received());
    self->read();
  });
}

void LoadViewer::take(std::span<const std::uint8_t> bytes) {
  if (socket_.is_text()) return take_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const auto stamp = protocol::read_stamp(bytes);
  if (!stamp) return;
  if (!std::exchange(joined_, true)) {
    ++tally_.joined;
    ++tally_.settled;
  }
  if (tally_.measuring) {
    ++frames_;
    ++tally_.frames;
    tally_.bytes += bytes.size();
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
  tally_.failures.push_back(socket_.why(doing, error));
  if (!joined_) ++tally_.settled;
}

}  // namespace weft::net
