#include "net/load.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "net/secure.h"
#include "protocol/frame.h"
#include "protocol/message.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

namespace {

constexpr auto kJoinTime = std::chrono::seconds(30);
/// So many viewers may be joining at a time.
constexpr int kJoining = 32;
constexpr double kServersRate = 60;           // frames a second, at most
constexpr double kClockWraps = 4294967296.0;  // ms: frames have its low 32 bits

double own_cpu() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double now_ms() { return Milliseconds(Clock::now().time_since_epoch()).count(); }

/// What all viewers count in.
struct Tally {
  bool measuring = false;
  int joined = 0, settled = 0;  ///< settled: joined, or given up
  std::uint64_t frames = 0, bytes = 0;
  std::vector<double> ages;
  std::vector<std::string> failures;
};

/// One viewer: joins, tells its distance, acknowledges each frame when it would have shown it.
class LoadViewer : public std::enable_shared_from_this<LoadViewer> {
 public:
  /// With `tls` where the URL asks for it.
  LoadViewer(asio::io_context& io, const Url& url, const ClientSecurity& security, TlsContext tls,
             double distance, double rate, bool slow, Tally& tally)
      : ws_(TcpStream(io)),
        pause_(io),
        tls_(std::move(tls)),
        url_(url),
        security_(security),
        distance_(distance),
        rate_(rate),
        slow_(slow),
        tally_(tally) {}

  void join(const tcp::resolver::results_type& where) {
    beast::get_lowest_layer(ws_).expires_after(kJoinTime);
    beast::get_lowest_layer(ws_).async_connect(
        where, [self = shared_from_this()](error_code error, const tcp::endpoint&) {
          if (error) return self->fail("connecting", error);
          if (self->tls_) return self->begin_tls();
          self->shake_hands();
        });
  }

  void leave() {
    leaving_ = true;
    beast::get_lowest_layer(ws_).close();
    pause_.cancel();
  }

  bool slow() const { return slow_; }
  bool joined() const { return joined_; }
  std::uint64_t frames() const { return frames_; }

 private:
  void begin_tls() {
    begin_client_tls(ws_.next_layer(), tls_, url_, security_)
        .async_handshake(asio::ssl::stream_base::client, [self = shared_from_this()](error_code error) {
          if (error) return self->fail("TLS", error);
          self->shake_hands();
        });
  }

  void shake_hands() {
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

  void greet() {
    // Where it takes fewer than there are, each when it is due: with two on the way two came at a time.
    say(protocol::Hello{"weft bench", {"flow.ack"}, takes_all() ? 2 : 1});
    say(protocol::Camera{distance_, std::nullopt});
    asked_ms_ = now_ms();
    say(protocol::Ping{0});
    read();
  }

  /// Asks for no reply: as clients send what they send most.
  void say(const protocol::Command& command) {
    queue_.push_back(protocol::to_text({std::nullopt, command}));
    if (queue_.size() == 1) write();
  }

  void write() {
    ws_.text(true);
    ws_.async_write(asio::buffer(queue_.front()), [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return;  // the read that is under way tells why
      self->queue_.pop_front();
      if (!self->queue_.empty()) self->write();
    });
  }

  void read() {
    ws_.async_read(incoming_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->fail("reading", error);
      self->take();
      self->incoming_.clear();
      self->read();
    });
  }

  void take() {
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
      if (!slow_ && clock_offset_) {
        const double age = std::fmod(now_ms() + *clock_offset_ - stamp->server_ms, kClockWraps);
        tally_.ages.push_back(age - kClockWraps * std::round(age / kClockWraps));
      }
    }
    // What it has shown before the next one is due.
    shown_ = stamp->frame;
    if (std::exchange(waits_, true)) return;
    pause_.expires_after(std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(slow_ ? 1.0 : std::max(0.0, next_due() - now_ms()) / 1e3)));
    pause_.async_wait([self = shared_from_this()](error_code error) {
      if (error) return;
      self->waits_ = false;
      self->due_ms_ = now_ms();
      self->say(protocol::Ack{self->shown_});
    });
  }

  /// It takes each frame as it comes.
  bool takes_all() const { return !slow_ && rate_ >= kServersRate; }

  double next_due() const { return takes_all() ? 0 : due_ms_ + 1e3 / rate_; }

  void take_text(std::string_view text) {
    if (clock_offset_ || text.find("\"pong\"") == std::string_view::npos) return;
    const auto pong = nlohmann::json::parse(text, nullptr, false);
    if (!pong.is_object() || !pong.contains("server_ms")) return;
    clock_offset_ = pong["server_ms"].get<double>() - (asked_ms_ + now_ms()) / 2;
  }

  void fail(const char* doing, error_code error) {
    if (leaving_) return;
    std::string why = std::string(doing) + ": " + error.message();
    if (error == websocket::error::upgrade_declined)
      why = "refused: " + std::to_string(response_.result_int()) + " " + response_.body();
    if (error == websocket::error::closed) why = "closed: " + std::to_string(ws_.reason().code);
    while (why.ends_with('\n')) why.pop_back();
    tally_.failures.push_back(std::move(why));
    if (!joined_) ++tally_.settled;
  }

  websocket::stream<Transport> ws_;
  SteadyTimer pause_;
  const TlsContext tls_;
  const Url& url_;
  const ClientSecurity& security_;
  const double distance_, rate_;
  const bool slow_;
  Tally& tally_;
  websocket::response_type response_;
  beast::flat_buffer incoming_;
  std::deque<std::string> queue_;  ///< of what is being sent the first; one that is pushed moves none
  std::uint64_t frames_ = 0;
  std::uint32_t shown_ = 0;
  double asked_ms_ = 0, due_ms_ = 0;
  std::optional<double> clock_offset_;  ///< of the server's clock to this one's, ms
  bool joined_ = false, waits_ = false, leaving_ = false;
};

/// Viewer `i` of `count` is at the distance whose share of the mix it falls into.
double distance_of(const LoadPlan& plan, int i) {
  const double place = (i + 0.5) / plan.viewers;
  if (place < plan.mix[0]) return plan.distances[0];
  return place < plan.mix[0] + plan.mix[1] ? plan.distances[1] : plan.distances[2];
}

}  // namespace

std::size_t make_room_for_connections() {
  constexpr rlim_t kOthers = 32;  // standard streams, event loop
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur > kOthers ? limit.rlim_cur - kOthers : 0;
}

double LoadResult::age(double percent) const {
  if (ages.empty()) return 0;
  const auto last = static_cast<double>(ages.size() - 1);
  return ages[static_cast<std::size_t>(std::lround(last * percent / 100))];
}

LoadResult load(const Url& url, const LoadPlan& plan, const ClientSecurity& security,
                const std::function<void()>& joined) {
  asio::io_context io{1};
  TlsContext tls;
  try {
    if (url.secure) tls = client_tls(security.authorities);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(error.what());
  }
  const auto where = resolve(io, url);
  Tally tally;
  std::vector<std::shared_ptr<LoadViewer>> viewers;
  const int stride = plan.slow > 0 ? std::max(1, static_cast<int>(std::lround(1 / plan.slow))) : 0;
  const auto begun_at = Clock::now(), until = begun_at + kJoinTime;
  while (tally.settled < plan.viewers && Clock::now() < until) {
    const auto begun = static_cast<int>(viewers.size());
    if (begun < plan.viewers && begun - tally.settled < kJoining) {
      viewers.push_back(std::make_shared<LoadViewer>(io, url, security, tls, distance_of(plan, begun),
                                                     plan.rate, stride > 0 && begun % stride == 0, tally));
      viewers.back()->join(where);
    } else {
      io.run_one_for(std::chrono::milliseconds(10));
    }
    if (io.stopped()) io.restart();  // it stops when nobody has anything to do
    // Not all that is ready: frames may come faster than they are taken, and others are to join still.
    for (int taken = 0; taken < kJoining && io.poll_one() > 0; ++taken) continue;
  }
  if (tally.joined == 0)
    throw ConnectionError("no viewer could join at " + host_header(url) + ": " +
                          (tally.failures.empty() ? "no frame came" : tally.failures.front()));
  // Of those who have not answered at all.
  for (int missing = tally.settled; missing < plan.viewers; ++missing)
    tally.failures.emplace_back("no frame came in " + std::to_string(kJoinTime.count()) + " s");
  LoadResult result;
  result.joined = tally.joined;
  result.joining = std::chrono::duration<double>(Clock::now() - begun_at).count();
  joined();
  const double cpu = own_cpu();
  const auto start = Clock::now();
  tally.measuring = true;
  io.run_for(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(plan.seconds)));
  tally.measuring = false;
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.own_cpu = own_cpu() - cpu;
  result.failures = std::move(tally.failures);
  result.frames = tally.frames;
  result.bytes = tally.bytes;
  result.ages = std::move(tally.ages);
  std::sort(result.ages.begin(), result.ages.end());
  bool first = true;
  for (const auto& viewer : viewers) {
    if (!viewer->slow() && viewer->joined()) {
      const double rate = static_cast<double>(viewer->frames()) / result.seconds;
      result.fewest = first ? rate : std::min(result.fewest, rate);
      result.most = std::max(result.most, rate);
      first = false;
    }
    viewer->leave();
  }
  io.run_for(std::chrono::seconds(1));
  return result;
}

}  // namespace weft::net
